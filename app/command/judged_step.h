#pragma once

/// @file judged_step.h
/// A solution of another program, and what a run finds of it.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command/commands.h"
#include "app/command/level_files.h"
#include "app/result/judgement.h"
#include "tribound/case/config.h"
#include "tribound/certify/truth/foreign_solution.h"
#include "tribound/io/record/report.h"
#include "tribound/mesh/import/imported_solution.h"

namespace tribound::app
{

/// A case on its first mesh, which is theirs.
template <int dim>
struct JudgedCase
{
  JudgedCase(const case_file::Config& config, mesh::Mesh<dim> first);
  JudgedCase(const JudgedCase&) = delete;
  JudgedCase& operator=(const JudgedCase&) = delete;

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  std::vector<problem::Quantity<dim>> quantities;
  io::CaseFacts facts;
  double sharpness;
  bool is_path;  ///< whether it has load steps
};

/// What they have computed for a quantity, in each of their steps, as a user gives it.
struct GivenNumber
{
  std::string text;  ///< NAME=VALUE,VALUE
  std::string name;
  std::vector<double> values;
};

/// A step of theirs beside levels of a run, or beside the load step that it belongs to.
template <int dim>
class JudgedStep
{
 public:
  using Level = std::shared_ptr<const KeptLevel<dim>>;

  /// `number`: its place in `numbers`; `t`: of its load step, where it is known before the run. Keeps a
  /// reference to the case. Throws InputError where the solution is
  /// on another mesh, and for a number without a quantity.
  JudgedStep(const JudgedCase<dim>& judged_case, const JudgeRequest& request, const io::HashedFile& file,
             const mesh::ImportedSolution& solution, std::span<const GivenNumber> numbers, std::size_t number,
             const std::optional<double>& t);

  /// Compares with the level, which is kept where it has a bound.
  void judge(const Level& level, const io::LevelRecord& record);
  /// What was found holds; judge() then begins with the next pass over the load steps.
  void accept();
  /// What holds; before any accept() the last judgement.
  [[nodiscard]] const JudgementRecord& record() const { return found().record; }
  /// Whether the level of the last judgement is kept, and whether its error is larger than that of another.
  [[nodiscard]] bool has_level() const { return last_.level != nullptr; }
  [[nodiscard]] bool is_worse_than(const JudgedStep& other) const;
  void drop_level() { last_.level.reset(); }

  /// Writes judged_cells.csv, and their displacement with the distances as judged.vtu. There must be a bound.
  void write_fields(const std::filesystem::path& directory) const;
  /// For the page; null unless there is a bound and the level is kept as a whole.
  [[nodiscard]] io::Json surfaces() const;

 private:
  struct Found
  {
    JudgementRecord record{};
    Level level{};
  };

  [[nodiscard]] const Found& found() const { return accepted_ ? *accepted_ : last_; }
  /// The data of the load step.
  [[nodiscard]] problem::Problem<dim> problem_of(const JudgementRecord& record) const
  {
    return record.t ? case_.problem.at(*record.t) : case_.problem;
  }
  void measure_numbers();
  void measure_stress();
  void measure_penetration();
  void take_intervals(const certify::EnergyBound& energy);

  const JudgedCase<dim>& case_;
  certify::ForeignSolution<dim> theirs_;
  fem::LagrangeSpace<dim> space_;
  std::vector<std::optional<double>> given_;  ///< of every quantity
  Found last_{};
  std::optional<Found> accepted_{};
};

}  // namespace tribound::app
