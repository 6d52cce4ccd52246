#pragma once

/// @file study.h
/// The results of `tribound study`: a case solved in several variants and measured against a reference
/// solution. Plain data in; study.csv, study.json and the tables on the screen out. What is unknown is
/// absent.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/certify/truth/true_error.h"
#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/report.h"

namespace tribound::app
{

/// A level with the true errors of its solution.
struct StudiedLevel
{
  io::LevelRecord record;
  std::optional<certify::SolutionError> error;  ///< against the reference
  std::optional<double> dual_norm;              ///< of the residual, from below
  std::optional<bool> intervals_agree{};        ///< of all quantities, with those of the reference

  /// bound / dual norm: at least 1.
  [[nodiscard]] std::optional<double> effectivity() const;
  /// bound / ||sigma(u_ref - u_h)||, for comparison with other methods: it need not be at least 1.
  [[nodiscard]] std::optional<double> stress_effectivity() const;
  /// Bound of the error in the energy norm / error against the reference, where both refer to the same
  /// solution.
  [[nodiscard]] std::optional<double> energy_effectivity() const;
};

/// The names of the variants, in the order of all tables. `_converged`: Newton's method runs to its
/// tolerance.
inline constexpr std::array<const char*, 4> variant_names = {"adaptive", "adaptive_converged", "uniform",
                                                             "uniform_converged"};

/// The case solved in one way.
struct StudyVariant
{
  std::string name;
  certify::RunStatus status = certify::RunStatus::uncertified;
  std::string reason;  ///< why it is not certified; empty if it is
  std::vector<StudiedLevel> levels;
};

/// The solution used in place of the exact one.
struct StudyReference
{
  int degree = 0;
  io::LevelRecord level;     ///< the mesh, the bound and the figures
  double required = 0;       ///< upper limit for its relative bound
  bool fine_enough = false;  ///< whether it is
  std::string reason;        ///< why it is not
};

struct Study
{
  io::CaseFacts facts;
  io::EffectiveCase effective;
  std::string case_file = "case.toml";  ///< its name in the output directory
  io::BuildFacts build;
  double gamma_lin = 0;
  std::string marking;
  double theta = 0;
  std::vector<StudyVariant> variants;  ///< those done so far, in the order of variant_names
  std::optional<StudyReference> reference;
  std::string interruption;                           ///< empty for a complete study
  std::vector<std::pair<std::string, double>> times;  ///< s per stage
};

/// The variant of this name, or null.
[[nodiscard]] const StudyVariant* find_variant(const Study& study, std::string_view name);

/// The kind of its runs.
[[nodiscard]] certify::RunKind run_kind(const Study& study);

/// The exponents of energy error and bound with respect to the degrees of freedom.
struct Rates
{
  std::optional<double> error;
  std::optional<double> bound;
};

/// From level `number` - 1 to level `number`; nothing for level 0.
[[nodiscard]] Rates level_rates(const StudyVariant& variant, std::size_t number);
/// Fitted over the last half of the levels, see fitted_rate().
[[nodiscard]] Rates fitted_rates(const StudyVariant& variant);

/// The effect of stopping Newton's method early on the energy error, for every level with the criterion:
/// (error with - error without) / error without, at the same number of degrees of freedom, since the two runs
/// may refine different cells (value_at). Nothing where the run without has no mesh of that size.
[[nodiscard]] std::vector<std::optional<double>> error_differences(const StudyVariant& with,
                                                                   const StudyVariant& without);

/// What is wrong if an effectivity is below 1, or an error in the energy norm exceeds the sum of the bound
/// and that of the reference, naming the level; empty if the guarantees hold.
[[nodiscard]] std::string violation(const Study& study);

/// A row per variant and level; the columns are those of docs/output.md.
[[nodiscard]] std::string study_csv(const Study& study);

/// The same with the reference, the rates and the comparisons; unknown numbers are null. Then its text.
[[nodiscard]] io::Json study_object(const Study& study);
[[nodiscard]] std::string study_json(const Study& study);

/// The tables of the variants, of Newton's steps, the rates and where the files are.
[[nodiscard]] std::string study_text(const Study& study, const std::string& directory);

/// Runs `script` with the directory of a study as its argument and waits for it. Returns the error; empty on
/// success.
[[nodiscard]] std::string run_figure_script(const std::filesystem::path& script,
                                            const std::filesystem::path& directory);

/// Draws the figures of the study in `directory` and says on stdout where they are or why there are none.
void draw_figures(const std::filesystem::path& directory);

}  // namespace tribound::app
