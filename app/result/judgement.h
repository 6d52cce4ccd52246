#pragma once

/// @file judgement.h
/// The report of `tribound judge`: how wrong the solution of another program is. Plain data in, text out.

#include <optional>
#include <string>
#include <vector>

#include "tribound/certify/bound/balance.h"
#include "tribound/certify/energy/quantity_interval.h"
#include "tribound/certify/truth/judgement.h"
#include "tribound/certify/truth/their_forces.h"
#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/facts.h"

namespace tribound::app
{

inline constexpr const char* judgement_schema = "1";

/// "7.31 %".
[[nodiscard]] std::string percent(double part);

/// A number of theirs beside the interval that contains the exact one.
struct JudgedNumber
{
  certify::QuantityInterval interval{};
  std::optional<double> theirs{};  ///< absent: it does not follow from what was read
  std::string unit{};

  /// The least and the largest possible error; nothing where either is not known.
  [[nodiscard]] std::optional<certify::ErrorInterval> wrong_by() const;
};

/// The force on the body at a boundary: by their stress, and in equilibrium with all others.
struct JudgedForce
{
  std::string boundary{};
  std::vector<double> theirs{};
  std::vector<double> ours{};
};

struct JudgementRecord
{
  io::CaseFacts facts{};
  io::HashedFile solution{};  ///< the file
  std::string description{};  ///< what it is
  std::string read_as{};
  double node_distance = 0;
  double curved_distance = 0;
  long their_cells = 0;
  std::string target{};                           ///< the solution that the error refers to; empty: no bound
  std::string reason{};                           ///< why there is no bound; empty: there is one
  std::optional<certify::Judgement> judgement{};  ///< where there is a bound
  std::vector<JudgedNumber> numbers{};
  std::vector<JudgedForce> forces{};  ///< where their stress was read
  std::optional<double>
      imbalance{};  ///< of their forces and the loads inside, over the largest force of ours
  std::optional<double> penetration{};        ///< the largest; absent: no contact
  std::optional<certify::Tension> tension{};  ///< where their stress was read and bodies may part
  std::string penetrated{};                   ///< the boundary
  double sharpness = 0;
  long cells = 0;  ///< of the mesh that it was judged with
  std::optional<int> load_step{};
  std::optional<double> t{};  ///< of the load step
  std::optional<double> accept{};

  /// Sets the forces of ours, and the imbalance.
  void balance(const certify::Balance& ours);
  /// Whether the bound is at most `sharpness` times the distance.
  [[nodiscard]] bool is_sharp() const;
  /// Whether that is so, or with `accept` whether the error is known to be below or above it.
  [[nodiscard]] bool is_settled() const { return accept ? judgement && status() != "undecided" : is_sharp(); }
  /// "judged", "wide" (the interval is wider than asked for) or "no bound"; with `accept` "accepted",
  /// "rejected" or "undecided".
  [[nodiscard]] std::string status() const;
  /// The largest possible relative error of their displacement, which may be infinite; nothing without a
  /// bound.
  [[nodiscard]] std::optional<double> largest_error() const;
};

/// Of a status "wide", what is said behind it; else nothing.
[[nodiscard]] std::string why_wide(const JudgementRecord& record);
/// As printed; `directory`: of the files.
[[nodiscard]] std::string judgement_text(const JudgementRecord& record, const std::string& directory);
/// The fields of docs/output.md; what is unknown is null.
[[nodiscard]] io::Json judgement_object(const JudgementRecord& record);

/// A row for every cell of theirs: centre, region, distance, part of the square of the whole, and whether it
/// is among the fewest cells without which at most half of the distance is left.
template <int dim>
[[nodiscard]] std::string judged_cells_csv(const mesh::Mesh<dim>& mesh, const certify::JudgedField& field);

}  // namespace tribound::app
