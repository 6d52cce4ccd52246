#include "app/console/balance_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "app/console/text.h"

namespace tribound::app
{

namespace
{

constexpr std::array axes = {"x", "y", "z"};

double largest(std::span<const double> values, double start)
{
  for (const double value : values) start = std::max(start, std::abs(value));
  return start;
}

/// Rounding is not shown as digits.
std::string cell(double value, double scale)
{
  return fmt::format("{:>13.6g}", std::abs(value) > 1e-9 * scale ? value : 0.0);
}

std::string label(const certify::BalanceRow& row)
{
  if (row.kind == certify::BalanceKind::load) return row.name + ", " + row.source;
  return row.name;
}

}  // namespace

std::string balance_text(const certify::Balance& balance)
{
  const std::size_t dim = balance.about.size();
  std::size_t width = 0;
  double force = 0;
  double moment = 0;
  for (const certify::BalanceRow& row : balance.rows)
  {
    width = std::max(width, label(row).size());
    force = largest(row.force, force);
    if (row.moment) moment = largest(*row.moment, moment);
  }
  std::string head;
  for (std::size_t i = 0; i < dim; ++i) head += fmt::format("{:>13}", fmt::format("force {}", axes[i]));
  for (std::size_t i = 0; i < (dim == 2 ? 1 : dim); ++i)
    head += fmt::format("{:>13}", dim == 2 ? "moment" : fmt::format("moment {}", axes[i]));
  std::string text = line("balance", fmt::format("{:<{}}{}", "", width + 10, head));
  for (const certify::BalanceRow& row : balance.rows)
  {
    std::string numbers;
    for (const double value : row.force) numbers += cell(value, force);
    if (row.moment)
      for (const double value : *row.moment) numbers += cell(value, moment);
    else
      for (std::size_t i = 0; i < (dim == 2 ? 1 : dim); ++i) numbers += fmt::format("{:>13}", "-");
    text += line("", fmt::format("{:<10}{:<{}}{}", certify::to_string(row.kind), label(row), width, numbers));
  }
  text += line("", fmt::format("on the body; moments about ({:.6g})", fmt::join(balance.about, ", ")));
  const std::string note = certify::moment_note(balance);
  return note.empty() ? text : text + line("", note);
}

template <int dim>
Point<dim> moment_point(const case_file::OutputConfig& output, const mesh::Mesh<dim>& mesh)
{
  if (output.moment_about.empty()) return certify::centroid<dim>(mesh);
  if (output.moment_about.size() != dim)
    throw InputError(output.moment_about_where,
                     fmt::format("has {} numbers, the mesh is {}D", output.moment_about.size(), dim),
                     fmt::format("{} coordinates of a point", dim));
  return Point<dim>(output.moment_about.data());
}

template Point<2> moment_point(const case_file::OutputConfig&, const mesh::Mesh<2>&);
template Point<3> moment_point(const case_file::OutputConfig&, const mesh::Mesh<3>&);

}  // namespace tribound::app
