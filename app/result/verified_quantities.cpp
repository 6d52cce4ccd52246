#include "app/result/verification.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console/text.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/error_bars.h"

namespace tribound::app
{

namespace
{

std::string ends(const certify::QuantityInterval& interval)
{
  return fmt::format("[{:.9g}, {:.9g}]", interval.lower, interval.upper);
}

/// The outcome of the comparison with the richer solution, in words.
std::string words_of_comparison(const VerifiedQuantity& quantity)
{
  if (!quantity.comparison.agree) return "not compared: " + quantity.comparison.reason;
  if (!*quantity.comparison.agree) return "violated: the richer solution is in " + ends(*quantity.richer);
  const auto position = quantity.position();
  if (!position) return "holds";
  if (*position >= 0 && *position <= 1) return fmt::format("holds, at {:.0f} % of it", 100 * *position);
  return fmt::format("holds a part of {}, that of the richer solution, whose value is at {:.0f} % of it",
                     ends(*quantity.richer), 100 * *position);
}

std::string words_of(const VerifiedQuantity& quantity, const std::string& unit)
{
  if (!quantity.interval.reason.empty()) return io::words_of(quantity.interval, unit);
  certify::QuantityInterval shown = quantity.interval;
  if (quantity.richer) shown.value = quantity.richer->value;
  return io::words_of(shown, unit) + ": " + words_of_comparison(quantity);
}

io::Json json(const VerifiedQuantity& quantity)
{
  const certify::QuantityInterval& interval = quantity.interval;
  const std::optional<bool>& agree = quantity.comparison.agree;
  io::Json object{{"name", interval.name},
                  {"value", interval.value},
                  {"lower", nullptr},
                  {"upper", nullptr},
                  {"exact", interval.exact},
                  {"richer_value", nullptr},
                  {"richer_lower", nullptr},
                  {"richer_upper", nullptr},
                  {"holds", agree ? io::Json(*agree) : io::Json(nullptr)},
                  {"position", io::number_or_null(quantity.position())},
                  {"reason", io::text_or_null(quantity.comparison.reason)}};
  if (interval.reason.empty()) object.update({{"lower", interval.lower}, {"upper", interval.upper}});
  if (!quantity.richer) return object;
  object["richer_value"] = quantity.richer->value;
  if (quantity.richer->reason.empty())
    object.update({{"richer_lower", quantity.richer->lower}, {"richer_upper", quantity.richer->upper}});
  return object;
}

}  // namespace

std::optional<double> VerifiedQuantity::position() const
{
  const double width = interval.upper - interval.lower;
  if (!richer || !interval.reason.empty() || interval.exact || !(width > 0)) return std::nullopt;
  return (richer->value - interval.lower) / width;
}

std::vector<VerifiedQuantity> verified_quantities(const certify::EnergyBound& bound,
                                                  const std::optional<certify::EnergyBound>& richer)
{
  std::vector<VerifiedQuantity> result;
  for (const certify::QuantityInterval& interval : bound.quantities)
  {
    VerifiedQuantity& quantity = result.emplace_back(VerifiedQuantity{.interval = interval});
    quantity.comparison.reason = richer ? richer->reason : "there is no richer solution";
    if (!richer) continue;
    const auto found = std::ranges::find(richer->quantities, interval.name, &certify::QuantityInterval::name);
    if (found == richer->quantities.end()) continue;  // its bound failed
    quantity.richer = *found;
    quantity.comparison = certify::compare_intervals(bound, interval, *richer, *found);
  }
  return result;
}

std::optional<bool> hold(const std::vector<VerifiedQuantity>& quantities)
{
  std::optional<bool> all;
  for (const VerifiedQuantity& quantity : quantities)
    if (quantity.comparison.agree) all = all.value_or(true) && *quantity.comparison.agree;
  return all;
}

std::string violation(const std::vector<VerifiedQuantity>& quantities)
{
  const auto found =
      std::ranges::find_if(quantities, [](const VerifiedQuantity& q) { return q.comparison.agree == false; });
  if (found == quantities.end()) return {};
  return fmt::format("the interval {} of \"{}\" has no point in common with {}, that of the richer solution",
                     ends(found->interval), found->interval.name, ends(*found->richer));
}

std::string quantities_text(const std::vector<VerifiedQuantity>& quantities, const io::CaseFacts& facts)
{
  std::string text;
  for (const VerifiedQuantity& quantity : quantities)
    text += line(text.empty() ? "quantities" : "",
                 quantity.interval.name + ": " + words_of(quantity, facts.unit_of(quantity.interval.name)));
  return text;
}

io::Json quantities_json(const std::vector<VerifiedQuantity>& quantities)
{
  io::Json array = io::Json::array();
  for (const VerifiedQuantity& quantity : quantities) array.push_back(json(quantity));
  return array;
}

}  // namespace tribound::app
