#include "tribound/io/record/history_check.h"

namespace tribound::io
{

namespace
{

std::optional<double> peak_of(const adapt::PathEnd& end)
{
  return end.peak ? std::optional(end.peak->t) : std::nullopt;
}

}  // namespace

std::optional<double> ComparedFigure::difference() const
{
  return path && check ? std::optional(*check - *path) : std::nullopt;
}

std::vector<ComparedFigure> compare(const adapt::PathEnd& end, const LoadStepRecord& last,
                                    const HistoryCheck& check)
{
  if (!check.end.failure.empty() || !check.last) return {};
  const auto figure = [&](const char* name, const char* word, double LoadStepRecord::*value,
                          std::optional<problem::UnitOf> unit = {}) {
    return ComparedFigure{name, word, last.*value, (*check.last).*value, unit};
  };
  return {{"peak_t", "t of the peak", peak_of(end), peak_of(check.end)},
          figure("t", "at the end t", &LoadStepRecord::t),
          figure("effective_normal", "N", &LoadStepRecord::effective_normal, problem::UnitOf::force),
          figure("tangential", "V", &LoadStepRecord::tangential, problem::UnitOf::force),
          figure("dissipated", "dissipated", &LoadStepRecord::dissipated, problem::UnitOf::energy)};
}

const char* words_of_check()
{
  return "the path once more, with half the steps on a mesh with half the edges, without bounds; not "
         "guaranteed: what both paths have in common does not show, and the branch may be another one. "
         "Compared are the peaks, and the last step of either path";
}

}  // namespace tribound::io
