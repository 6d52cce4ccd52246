#include "app/command/step_pairs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "app/console/text.h"
#include "tribound/base/error.h"

namespace tribound::app
{

namespace
{

/// Whether the times are the same up to the digits that files have.
bool is_same(double a, double b)
{
  constexpr double digits = 1e-5;
  return std::abs(a - b) <= digits * std::max(std::abs(a), std::abs(b));
}

/// "3 load steps (t = 0.5, 1, 2)"; of many the first and the last ones.
std::string list_of(std::span<const double> times, std::size_t n, std::string_view one, std::string_view many)
{
  constexpr std::size_t most = 8;
  std::string number = count(static_cast<long>(n), one, many);
  if (times.empty()) return number;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (i < most / 2 || i + most / 2 >= times.size() || times.size() <= most)
      texts.push_back(fmt::format("{:g}", times[i]));
    else if (i == most / 2)
      texts.emplace_back("...");
  return fmt::format("{} (t = {})", number, fmt::join(texts, ", "));
}

/// The times of theirs; none unless every step has one.
std::vector<double> times_of(std::span<const TheirStep> theirs)
{
  std::vector<double> times;
  for (const TheirStep& their : theirs)
    if (their.step) times.push_back(their.step->t);
  if (times.size() < theirs.size()) times.clear();
  return times;
}

/// For each load step the step of theirs with the same t; nothing unless there is one for each.
std::optional<std::vector<std::size_t>> pairs_by_time(std::span<const double> load_steps,
                                                      std::span<const double> times)
{
  std::vector<std::size_t> places;
  for (const double t : load_steps)
  {
    const auto same = [t](double time) { return is_same(t, time); };
    const auto place = static_cast<std::size_t>(std::ranges::find_if(times, same) - times.begin());
    if (std::ranges::count_if(times, same) != 1 || std::ranges::count(places, place) > 0) return std::nullopt;
    places.push_back(place);
  }
  return places;
}

/// Whether they are the numbers of the steps: programs have those for a time, too.
bool are_numbers(std::span<const double> times)
{
  double number = 0;
  return std::ranges::all_of(times, [&](double time) { return time == ++number; });
}

/// Whether a load step has its t in another place than its own, as where a list begins with an initial state.
bool contradicts_order(std::span<const double> load_steps, std::span<const double> times)
{
  if (are_numbers(times)) return false;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!is_same(load_steps[i], times[i]) &&
        std::ranges::any_of(times, [&](double time) { return is_same(load_steps[i], time); }))
      return true;
  return false;
}

}  // namespace

std::vector<TheirStep> all_steps(const JudgeRequest& request)
{
  std::vector<TheirStep> result;
  for (const std::string& file : request.solutions)
  {
    mesh::ImportedSolution last = mesh::read_solution(file, {request.field, request.stress});
    for (const mesh::SolutionStep& step : last.steps) result.push_back({file, step});
    if (last.steps.empty()) result.push_back({file});
    result.back().solution = std::move(last);
  }
  return result;
}

std::vector<std::size_t> pair_steps(std::span<const double> load_steps, std::span<const TheirStep> theirs)
{
  const std::vector<double> times = times_of(theirs);
  if (auto places = pairs_by_time(load_steps, times)) return *std::move(places);
  if (theirs.size() != load_steps.size() || contradicts_order(load_steps, times))
    throw InputError(
        {.file = theirs.front().file + (theirs.front().file == theirs.back().file ? "" : ", ...")},
        fmt::format("has {}, the case {}", list_of(times, theirs.size(), "step", "steps"),
                    list_of(load_steps, load_steps.size(), "load step", "load steps")),
        "as many steps as the case has load steps, in their order, or one with the t of each; one alone is "
        "judged with --step and --load-step");
  std::vector<std::size_t> places(theirs.size());
  std::iota(places.begin(), places.end(), 0);
  return places;
}

}  // namespace tribound::app
