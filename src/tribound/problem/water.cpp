#include "tribound/problem/water.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "tribound/problem/nonnegative.h"

namespace tribound::problem
{

namespace
{

/// A pressure at a distance from the heel.
struct Node
{
  double s;
  double pressure;
};

/// The piecewise linear pressure, constant before the first node and after the last.
std::vector<Node> profile(const Seepage& seepage, double tip)
{
  const auto pressure = [&](const Field& level, double height)
  { return seepage.weight * std::max(0.0, level.constant() - height); };
  const double length = seepage.line.length();
  const double p_heel = pressure(seepage.head, seepage.line.heel.back());
  const double p_toe = pressure(seepage.tail, seepage.line.toe.back());
  const double begin = seepage.crack ? tip : 0;
  if (begin >= length) return {{length, p_heel}};
  std::vector<Node> nodes{{begin, p_heel}};
  if (const std::optional<Drain>& drain = seepage.drain; drain && tip < drain->at)
  {
    const double without = drain->from_full_head ? 1 : (length - drain->at) / (length - begin);
    nodes.push_back({drain->at, p_toe + (1 - drain->efficiency) * (p_heel - p_toe) * without});
  }
  nodes.push_back({length, p_toe});
  return nodes;
}

/// s, as a formula: "0.6*x+0.8*y-3".
std::string along(const BaseLine& line)
{
  const std::array<double, 3> e = line.direction();
  double offset = 0;
  std::string text;
  for (std::size_t i = 0; i < line.heel.size(); ++i)
  {
    offset -= e[i] * line.heel[i];
    if (e[i] != 0) text += fmt::format("({:.17g})*{}+", e[i], "xyz"[i]);
  }
  return text + fmt::format("({:.17g})", offset);
}

void require_level(const Field& level)
{
  if (!level.is_constant())
    throw InputError(level.where(), "varies in space", "a level of the water: a number, or a formula in t");
}

}  // namespace

double BaseLine::length() const
{
  double squares = 0;
  for (std::size_t i = 0; i < heel.size(); ++i) squares += std::pow(toe[i] - heel[i], 2);
  return std::sqrt(squares);
}

std::array<double, 3> BaseLine::direction() const
{
  const double size = length();
  std::array<double, 3> e{};
  for (std::size_t i = 0; i < heel.size(); ++i) e[i] = (toe[i] - heel[i]) / size;
  return e;
}

Water::Water(Field pressure) : pressure_(std::move(pressure)) {}

Water::Water(Seepage seepage) : seepage_(std::move(seepage)), pressure_(from_levels()) {}

/// p_toe and sum_j (k_{j-1} - k_j) max(0, s_j - s), k_j the fall per length behind node j. Its kinks are
/// those in Field::switches().
Field Water::from_levels() const
{
  require_level(seepage_->head);
  require_level(seepage_->tail);
  const std::vector<Node> nodes = profile(*seepage_, tip_);
  const std::string s = along(seepage_->line);
  std::string text = fmt::format("({:.17g})", nodes.back().pressure);
  double before = 0;
  for (std::size_t j = 0; j < nodes.size(); ++j)
  {
    const double behind = j + 1 == nodes.size()
                              ? 0
                              : (nodes[j].pressure - nodes[j + 1].pressure) / (nodes[j + 1].s - nodes[j].s);
    if (before != behind)
      text += fmt::format("+({:.17g})*max(0,({:.17g})-({}))", before - behind, nodes[j].s, s);
    before = behind;
  }
  return Field(text, seepage_->head.where(), "the pressure of the water");
}

Water Water::at(double t) const
{
  Water result = *this;
  if (!seepage_)
  {
    result.pressure_ = pressure_.at(t);
    return result;
  }
  result.seepage_->head = seepage_->head.at(t);
  result.seepage_->tail = seepage_->tail.at(t);
  result.pressure_ = result.from_levels();
  return result;
}

Water Water::with_crack_tip(double a) const
{
  Water result = *this;
  result.tip_ = a;
  if (follows_crack()) result.pressure_ = result.from_levels();
  return result;
}

bool Water::uses_time() const
{
  return seepage_ ? seepage_->head.uses_time() || seepage_->tail.uses_time() : pressure_.uses_time();
}

template <int dim>
double Water::operator()(const Point<dim>& x) const
{
  return seepage_ ? pressure_(x) : nonnegative_at<dim>(pressure_, x);
}

template double Water::operator()(const Point<2>&) const;
template double Water::operator()(const Point<3>&) const;

}  // namespace tribound::problem
