#include "tribound/case/keys.h"

#include <utility>

namespace tribound::case_file
{

Refusal point_loads()
{
  return {
      .keys = {"force", "forces", "point", "points", "point_load", "point_loads", "point_force",
               "point_forces", "nodal_force", "nodal_forces", "concentrated_force"},
      .problem = "a force needs an area: at a point the displacement under it is infinite, in 2D and in 3D",
      .hint =
          "traction = force / area on a boundary; in place of a point, a patch of given radius around it: "
          "traction = [0, \"abs(x - 1) < 0.1 ? -5/0.2 : 0\"], in 3D "
          "[0, 0, \"(x - 1)^2 + y^2 < 0.1^2 ? -5/(pi*0.1^2) : 0\"]; on a stiff part: rigid = { force = "
          "[0, -5], point = [1, 0] }"};
}

Value truth()
{
  return {.truth = true};
}

Value text(std::string hint, std::size_t least)
{
  return {.text = true, .least = least, .hint = std::move(hint)};
}

Value one_of(std::vector<std::string> words)
{
  return {.words = std::move(words)};
}

Value number_in(Interval interval, std::string hint)
{
  return {.number = interval, .hint = std::move(hint)};
}

Value integer_from(double lower, std::string hint, double upper)
{
  return {.number = Interval{.lower = lower, .upper = upper, .includes_lower = true, .includes_upper = true},
          .is_integer = true,
          .hint = std::move(hint)};
}

Value formula()
{
  return {.text = true, .is_formula = true};
}

Value datum()
{
  return {.text = true,
          .is_formula = true,
          .number = Interval{.lower = -reasonable.upper,
                             .upper = reasonable.upper,
                             .includes_lower = true,
                             .includes_upper = true}};
}

Value nonnegative_datum(std::string hint)
{
  Value value = datum();
  value.number->lower = 0;
  value.hint = std::move(hint);
  return value;
}

Value vector_of(Value item, std::string hint)
{
  return {.items = {std::move(item)}, .least = 2, .most = 3, .hint = std::move(hint)};
}

Value numbers(std::string hint)
{
  return vector_of(number_in(finite), std::move(hint));
}

Value data(std::string hint)
{
  return vector_of(datum(), std::move(hint));
}

Value direction(std::string hint)
{
  Value value = numbers(std::move(hint));
  value.has_length = true;
  return value;
}

Value array_of(Value item, std::size_t least, std::string hint)
{
  return {.items = {std::move(item)}, .least = least, .hint = std::move(hint)};
}

Value keys_of(const Table& table)
{
  return {.table = &table};
}

Value operator|(Value one, const Value& other)
{
  one.truth = one.truth || other.truth;
  one.text = one.text || other.text;
  one.is_formula = one.is_formula || other.is_formula;
  one.words.insert(one.words.end(), other.words.begin(), other.words.end());
  if (!one.number)
  {
    one.number = other.number;
    one.is_integer = other.is_integer;
  }
  if (one.items.empty() && !other.items.empty())
  {
    one.items = other.items;
    one.least = other.least;
    one.most = other.most;
    one.has_length = other.has_length;
  }
  if (one.table == nullptr) one.table = other.table;
  if (one.hint.empty()) one.hint = other.hint;
  return one;
}

std::vector<Key> operator+(std::vector<Key> keys, const std::vector<Key>& others)
{
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

}  // namespace tribound::case_file
