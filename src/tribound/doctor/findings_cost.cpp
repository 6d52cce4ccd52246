#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tribound/doctor/findings.h"

namespace tribound::doctor
{

namespace
{

/// Memory estimates are right within this factor (docs/doctor.md).
constexpr double memory_uncertainty = 1.5;

/// "0.52", "3.4", "150": two digits, no exponent.
std::string two_digits(double value)
{
  const double scale = std::pow(10, 1 - std::floor(std::log10(value)));
  const double rounded = std::round(value * scale) / scale;
  return fmt::format("{:.{}f}", rounded, rounded >= 10 ? 0 : rounded >= 1 ? 1 : 2);
}

std::string bytes_in_words(double bytes)
{
  return bytes < 0.995e9 ? two_digits(bytes / 1e6) + " MB" : two_digits(bytes / 1e9) + " GB";
}

std::string seconds_in_words(double seconds)
{
  if (seconds < 1) return "under 1 s";
  if (seconds < 120) return two_digits(seconds) + " s";
  return seconds < 7200 ? two_digits(seconds / 60) + " min" : two_digits(seconds / 3600) + " h";
}

/// Alternatives that fit into memory.
std::string memory_advice(const Diagnosis& diagnosis, const CostEstimate& cost)
{
  std::vector<std::string> ways;
  if (cost.method == algebra::LinearMethod::direct && diagnosis.multigrid_bytes <= diagnosis.memory.bytes)
    ways.push_back(
        fmt::format("solver.method = \"iterative\" (about {})", bytes_in_words(diagnosis.multigrid_bytes)));
  for (const CostEstimate& other : diagnosis.costs)
    if (other.degree < cost.degree && other.bytes <= diagnosis.memory.bytes)
      ways.push_back(fmt::format("degree {} (about {})", other.degree, bytes_in_words(other.bytes)));
  ways.emplace_back("a coarser first mesh, which the run refines where it pays");
  return fmt::format("take {}", fmt::join(ways, ", or "));
}

/// Compares the memory needed by the case with the available memory.
Finding memory_finding(const Diagnosis& diagnosis, const CostEstimate& cost)
{
  const double limit = diagnosis.memory.bytes;
  Finding finding{.code = "memory"};
  finding.numbers = {{"bytes", cost.bytes}, {"limit", limit}};
  finding.text = fmt::format("this case needs about {} on this mesh, {} {} ({})", bytes_in_words(cost.bytes),
                             cost.bytes > limit ? "more than" : "of", bytes_in_words(limit),
                             diagnosis.memory.from_case ? "adapt.max_memory" : "nine tenths of the machine");
  if (cost.bytes * memory_uncertainty <= limit) return finding;
  finding.severity = cost.bytes > limit ? Severity::warning : Severity::note;
  finding.advice = memory_advice(diagnosis, cost);
  return finding;
}

Finding cost_finding(const CostEstimate& cost, int degree_of_case)
{
  Finding finding{.code = fmt::format("cost_degree_{}", cost.degree)};
  finding.numbers = {{"degree", static_cast<double>(cost.degree)},
                     {"dofs", cost.dofs},
                     {"bytes", cost.bytes},
                     {"seconds", cost.seconds}};
  finding.text =
      fmt::format("degree {} on this mesh: {:.0f} degrees of freedom, about {} and {}{}", cost.degree,
                  cost.dofs, bytes_in_words(cost.bytes), seconds_in_words(cost.seconds),
                  cost.degree == degree_of_case ? " (this case)" : "");
  return finding;
}

}  // namespace

std::vector<Finding> cost_findings(const Diagnosis& diagnosis)
{
  std::vector<Finding> result;
  for (const CostEstimate& cost : diagnosis.costs)
  {
    result.push_back(cost_finding(cost, diagnosis.degree));
    if (cost.degree == diagnosis.degree && diagnosis.memory.bytes > 0)
      result.push_back(memory_finding(diagnosis, cost));
  }
  return result;
}

}  // namespace tribound::doctor
