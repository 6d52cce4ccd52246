#include "tribound/mesh/import/solution_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/mesh/import/file_text.h"

namespace tribound::mesh
{

namespace
{

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// In small letters, the surest first; of FEniCSx, MFEM, GetFEM, deal.II, CalculiX's converters, Salome.
constexpr std::array<std::string_view, 9> usual_displacements = {
    "displacement", "displacements", "u", "disp", "depl", "deplacement", "uh", "u_h", "solution"};
constexpr std::array<std::string_view, 11> usual_stresses = {
    "stress",        "stresses",  "sigma",     "s",       "sig",          "cauchy_stress",
    "cauchy stress", "sief_noeu", "sigm_noeu", "sigma_h", "stress tensor"};

/// Salome puts the name of the result before that of the field: "reslin__DEPL".
bool is_usual(std::string_view name, std::string_view usual)
{
  const std::string small = small_letters(name);
  return small == usual || small.ends_with("__" + std::string(usual));
}

std::string described(std::span<const FieldName> fields, std::string_view kind)
{
  if (fields.empty()) return fmt::format("the file has no {}", kind);
  std::vector<std::string> words;
  words.reserve(fields.size());
  for (const FieldName& field : fields)
    words.push_back(fmt::format("\"{}\" ({} components)", field.name, field.n_components));
  return fmt::format("the file has the {} {}", kind, fmt::join(words, ", "));
}

bool may_be_stress(const FieldName& field)
{
  const std::size_t n = field.n_components;
  return n == 3 || n == 4 || n == 6 || n == 9;
}

/// Which components are the displacement; none: it has none. Code_aster has forces of contact beside it.
std::vector<std::size_t> displacement_places(const FieldName& field)
{
  if (field.n_components == 2) return {0, 1};
  if (field.n_components == 3) return {0, 1, 2};
  std::vector<std::size_t> places;
  for (const std::string_view name : {"dx", "dy", "dz"})
    for (std::size_t i = 0; i < field.component_names.size(); ++i)
      if (small_letters(field.component_names[i]) == name) places.push_back(i);
  const bool has_space = places.size() == 2 || places.size() == 3;
  return has_space ? places : std::vector<std::size_t>{};
}

bool may_be_displacement(const FieldName& field)
{
  return !displacement_places(field).empty();
}

std::optional<std::size_t> named(std::span<const FieldName> fields, const std::string& wanted)
{
  const auto found = std::ranges::find(fields, wanted, &FieldName::name);
  if (found == fields.end()) return {};
  return static_cast<std::size_t>(found - fields.begin());
}

template <class May>
std::optional<std::size_t> usual_one(std::span<const FieldName> fields,
                                     std::span<const std::string_view> names, const May& may_be)
{
  for (const std::string_view usual : names)
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (is_usual(fields[i].name, usual) && may_be(fields[i])) return i;
  return {};
}

/// Whether each tensor of four numbers has the second equal to the third.
bool are_plane_tensors(std::span<const double> values)
{
  for (std::size_t i = 0; i + 3 < values.size(); i += 4)
  {
    const double size = std::abs(values[i]) + std::abs(values[i + 1]) + std::abs(values[i + 3]);
    if (std::abs(values[i + 1] - values[i + 2]) > 1e-5 * size) return false;
  }
  return true;
}

/// The symmetric part; `asymmetry` and `size` become the largest that are seen.
StressValues from_tensor(std::span<const double> t, double& asymmetry, double& size)
{
  for (const auto& [i, j] : {std::pair{1, 3}, std::pair{5, 7}, std::pair{2, 6}})
    asymmetry = std::max(asymmetry, std::abs(t[i] - t[j]));
  for (const double value : t) size = std::max(size, std::abs(value));
  return {t[0], t[4], t[8], (t[1] + t[3]) / 2, (t[5] + t[7]) / 2, (t[2] + t[6]) / 2};
}

/// The places in StressValues of components such as "SIXX" and "S_yz", if all are named so, each once.
std::vector<std::size_t> places_by_name(const FieldName& field)
{
  constexpr std::array<std::string_view, 9> ends = {"xx", "yy", "zz", "xy", "yz", "xz", "yx", "zy", "zx"};
  std::vector<std::size_t> places;
  for (const std::string& name : field.component_names)
  {
    const std::string small = small_letters(name);
    const auto end = std::ranges::find_if(ends, [&](std::string_view e) { return small.ends_with(e); });
    const auto place = static_cast<std::size_t>(end - ends.begin());
    if (place == ends.size()) return {};
    places.push_back(place < 6 ? place : place - 3);
    if (std::ranges::count(places, places.back()) > 1) return {};
  }
  return places;
}

/// In the order of the file, or the usual one for this number.
StressValues from_components(std::span<const double> s, std::span<const std::size_t> places)
{
  StressValues stress{};
  if (!places.empty())
    for (std::size_t i = 0; i < s.size(); ++i) stress[places[i]] = s[i];
  else if (s.size() == 3)
    stress = {s[0], s[1], 0, s[2], 0, 0};
  else
    std::ranges::copy(s, stress.begin());
  return stress;
}

}  // namespace

const Point<3> no_displacement = Point<3>::Constant(nan);
const StressValues no_stress = {nan, nan, nan, nan, nan, nan};

Point<3> displacement_of(const std::array<double, 3>& components)
{
  const Point<3> result(components[0], components[1], components[2]);
  return result.allFinite() ? result : no_displacement;
}

StressValues finite_stress(const StressValues& stress)
{
  const bool is_finite = std::ranges::all_of(stress, [](double value) { return std::isfinite(value); });
  return is_finite ? stress : no_stress;
}

std::size_t choose_displacement(std::span<const FieldName> fields, const std::string& wanted,
                                const Where& where, std::string_view kind)
{
  const auto found =
      wanted.empty() ? usual_one(fields, usual_displacements, may_be_displacement) : named(fields, wanted);
  if (!found)
    throw InputError(
        where,
        fmt::format("there is no displacement{}: {}", wanted.empty() ? "" : fmt::format(" \"{}\"", wanted),
                    described(fields, kind)),
        wanted.empty()
            ? "usual names are displacement, u, disp and DEPL, with 2 or 3 components; others by --field"
            : "--field is one of them, with 2 or 3 components");
  if (!may_be_displacement(fields[*found]))
    throw InputError(where,
                     fmt::format("\"{}\" has {} components, and cannot be a displacement",
                                 fields[*found].name, fields[*found].n_components),
                     "a displacement has 2 or 3 components; " + described(fields, kind));
  return *found;
}

std::optional<std::size_t> choose_stress(std::span<const FieldName> fields, const std::string& wanted,
                                         const Where& where, std::string_view kind)
{
  if (wanted.empty()) return usual_one(fields, usual_stresses, may_be_stress);
  const auto found = named(fields, wanted);
  if (!found)
    throw InputError(where, fmt::format("there is no stress \"{}\": {}", wanted, described(fields, kind)),
                     "--stress is one of them, with 3, 4, 6 or 9 components");
  if (!may_be_stress(fields[*found]))
    throw InputError(
        where,
        fmt::format("\"{}\" has {} components, and cannot be a stress", wanted, fields[*found].n_components),
        "a stress has 9 components, 6 (xx yy zz xy yz xz), 4 or 3 (xx yy xy)");
  return found;
}

std::vector<Point<3>> displacements_of(std::span<const double> values, const FieldName& field)
{
  const std::vector<std::size_t> places = displacement_places(field);
  std::vector<Point<3>> result;
  for (std::size_t begin = 0; begin < values.size(); begin += field.n_components)
  {
    std::array<double, 3> components{};
    for (std::size_t i = 0; i < places.size(); ++i) components[i] = values[begin + places[i]];
    result.push_back(displacement_of(components));
  }
  return result;
}

void set_stress(std::span<const double> values, const FieldName& field, const Where& where,
                ImportedSolution& solution)
{
  const std::size_t n = field.n_components;
  const std::vector<std::size_t> places = places_by_name(field);
  const bool is_plane_tensor = n == 4 && places.empty() && are_plane_tensors(values);
  double asymmetry = 0;
  double size = 0;
  solution.stress_has_zz = places.empty() ? n > 3 && !is_plane_tensor : std::ranges::count(places, 2) > 0;
  solution.stress.clear();
  solution.stress.reserve(values.size() / n);
  for (std::size_t i = 0; i + n <= values.size(); i += n)
  {
    const std::span<const double> s = values.subspan(i, n);
    solution.stress.push_back(finite_stress(n == 9            ? from_tensor(s, asymmetry, size)
                                            : is_plane_tensor ? StressValues{s[0], s[3], 0, s[1], 0, 0}
                                                              : from_components(s, places)));
  }
  constexpr double round_off = 1e-5;  // of numbers in single precision
  if (asymmetry > round_off * size)
    solution.notes.push_back(
        fmt::format("{}: the stress \"{}\" is not symmetric, by up to {:.3g}: its symmetric part is taken",
                    where.file, field.name, asymmetry));
  if (n == 4 && places.empty())
    solution.notes.push_back(fmt::format("{}: the 4 components of \"{}\" are taken as {}", where.file,
                                         field.name, is_plane_tensor ? "xx, xy, yx, yy" : "xx, yy, zz, xy"));
}

std::string element_words(const ImportedMesh& mesh)
{
  std::vector<std::string> words;
  for (const ElementBlock& block : mesh.cells)
    if (const std::string word = describe(block.type); std::ranges::find(words, word) == words.end())
      words.push_back(word);
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace tribound::mesh
