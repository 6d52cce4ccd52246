#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/solution_values.h"
#include "tribound/mesh/import/text_lines.h"

namespace tribound::mesh
{

namespace
{

/// The edges between bottom and top come before those of the top; in decks and VTK it is the other way round.
constexpr std::array hexahedron_20 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
constexpr std::array prism_15 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11};

struct FrdType
{
  int number;
  ElementType type;
  std::span<const int> order;  ///< place in the file of each node of ElementType; empty: the same
};

const std::array<FrdType, 10> frd_types = {{{1, {Shape::hexahedron, 8}, {}},
                                            {2, {Shape::prism, 6}, {}},
                                            {3, {Shape::tetrahedron, 4}, {}},
                                            {4, {Shape::hexahedron, 20}, hexahedron_20},
                                            {5, {Shape::prism, 15}, prism_15},
                                            {6, {Shape::tetrahedron, 10}, {}},
                                            {7, {Shape::triangle, 3}, {}},
                                            {8, {Shape::triangle, 6}, {}},
                                            {9, {Shape::quadrilateral, 4}, {}},
                                            {10, {Shape::quadrilateral, 8}, {}}}};

/// Values of nodes, where they stand in the file.
struct FrdField
{
  std::string name{};
  int state = 0;  ///< the fields of one increment have the same
  int step = 0;
  double time = 0;
  std::size_t n_components = 0;
  std::size_t width = 0;  ///< of the numbers of nodes
  TextLines::Place place{};
};

/// Records have fields of fixed width, which may touch: " -1", a number, numbers of 12 characters.
class FrdReader
{
 public:
  FrdReader(const std::filesystem::path& file, const SolutionChoice& choice)
      : where_{.file = file.string()},
        choice_(choice),
        content_(content_of(file, where_, {})),
        lines_(content_, where_)
  {
    solution_.mesh.source = where_;
  }

  ImportedSolution read();

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& hint = damaged) const
  {
    lines_.fail(problem, hint);
  }
  [[nodiscard]] std::string_view field(std::size_t begin, std::size_t width) const;
  [[nodiscard]] std::int64_t integer(std::size_t begin, std::size_t width, std::string_view what) const;
  [[nodiscard]] double number(std::size_t begin, std::string_view what) const;
  [[nodiscard]] Index node(std::int64_t number, std::string_view of) const;
  void next_in(std::string_view block);
  void set_width();
  void read_nodes();
  void read_elements();
  void read_element();
  void read_field_header();
  void check_elements() const;
  [[nodiscard]] const FrdField* last(const std::string& name) const;
  [[nodiscard]] std::string all_fields() const;
  template <std::size_t n, class Put>
  void read_values(const FrdField& field_to_read, const Put& put);
  void read_displacement(const FrdField& displacement);
  void read_stress(int state);

  static constexpr const char* damaged = "the file is damaged or cut off: write it again with CalculiX";
  static constexpr std::size_t n_key = 3;  ///< " -1"

  Where where_;
  SolutionChoice choice_;
  std::string content_;
  TextLines lines_;
  std::size_t width_ = 10;  ///< of the numbers of nodes and elements
  int step_ = 0;            ///< of the last 1PSTEP
  std::unordered_map<std::int64_t, Index> node_of_number_{};
  std::vector<FrdField> fields_{};
  ImportedSolution solution_{};
};

std::string_view FrdReader::field(std::size_t begin, std::size_t width) const
{
  const std::string_view line = lines_.line();
  return begin < line.size() ? trimmed(line.substr(begin, width)) : std::string_view{};
}

std::int64_t FrdReader::integer(std::size_t begin, std::size_t width, std::string_view what) const
{
  const auto value = integer_of(field(begin, width));
  if (!value) fail(fmt::format("{} is \"{}\"", what, field(begin, width)));
  return *value;
}

double FrdReader::number(std::size_t begin, std::string_view what) const
{
  constexpr std::size_t width = 12;
  const auto value = number_of(field(begin, width));
  if (!value) fail(fmt::format("{} is \"{}\", not a number", what, field(begin, width)));
  return *value;
}

Index FrdReader::node(std::int64_t number, std::string_view of) const
{
  const auto found = node_of_number_.find(number);
  if (found == node_of_number_.end())
    fail(fmt::format("node {} of {} does not exist: the file has {} nodes", number, of,
                     solution_.mesh.nodes.size()));
  return found->second;
}

void FrdReader::next_in(std::string_view block)
{
  if (!lines_.next()) fail(fmt::format("the file ends in the {}", block));
}

/// Of the records that follow, by the format at the end of the line.
void FrdReader::set_width()
{
  const std::string_view line = trimmed(lines_.line());
  const std::string_view format = line.substr(line.find_last_of(" \t") + 1);
  if (format != "0" && format != "1")
    fail("the file is binary",
         "write it as text: *NODE FILE and *EL FILE, not *NODE OUTPUT and *ELEMENT OUTPUT");
  width_ = format == "0" ? 5 : 10;
}

void FrdReader::read_nodes()
{
  ImportedMesh& mesh = solution_.mesh;
  if (!mesh.nodes.empty()) fail("the file has a second mesh", "results on one mesh: of one calculation");
  set_width();
  for (next_in("nodes"); field(0, n_key) != "-3"; next_in("nodes"))
  {
    if (field(0, n_key) != "-1") fail("a node begins with -1");
    const std::int64_t number_of_node = integer(n_key, width_, "the number of a node");
    const auto x = [&](std::size_t i) { return number(n_key + width_ + 12 * i, "a coordinate"); };
    const Point<3> position(x(0), x(1), x(2));
    if (!position.allFinite()) fail(fmt::format("node {} has no finite coordinates", number_of_node));
    if (!node_of_number_.try_emplace(number_of_node, static_cast<Index>(mesh.nodes.size())).second)
      fail(fmt::format("node {} is there twice", number_of_node));
    mesh.nodes.push_back(position);
    mesh.node_numbers.push_back(number_of_node);
  }
}

void FrdReader::read_elements()
{
  if (!solution_.mesh.cells.empty()) fail("the file has a second mesh", "results on one mesh");
  set_width();
  for (next_in("elements"); field(0, n_key) != "-3"; next_in("elements")) read_element();
}

void FrdReader::read_element()
{
  if (field(0, n_key) != "-1") fail("an element begins with -1");
  const std::int64_t label = integer(n_key, width_, "the number of an element");
  const std::int64_t number_of_type = integer(n_key + width_, 5, "the type of an element");
  if (number_of_type == 11 || number_of_type == 12)
    fail(fmt::format("element {} is a beam", label), "beams have no counterpart: leave them out");
  const auto type = std::ranges::find(frd_types, number_of_type, &FrdType::number);
  if (type == frd_types.end())
    fail(fmt::format("element {} is of type {}, which is not read", label, number_of_type), "types 1 to 10");
  auto block = std::ranges::find(solution_.mesh.cells, type->type, &ElementBlock::type);
  if (block == solution_.mesh.cells.end())
    block = solution_.mesh.cells.insert(block, ElementBlock{.type = type->type});
  std::vector<Index> nodes;
  const std::size_t n_per_line = width_ == 5 ? 15 : 10;
  const std::string name = fmt::format("element {}", label);
  for (int i = 0; i < type->type.n_nodes; ++i)
  {
    const std::size_t place = static_cast<std::size_t>(i) % n_per_line;
    if (place == 0) next_in("elements");
    if (field(0, n_key) != "-2") fail(fmt::format("the nodes of {} begin with -2", name));
    nodes.push_back(node(integer(n_key + width_ * place, width_, "the number of a node"), name));
  }
  for (int i = 0; i < type->type.n_nodes; ++i)
    block->nodes.push_back(nodes[type->order.empty() ? i : type->order[i]]);
  block->numbers.push_back(label);
}

/// 100C: what follows, "-4" and a "-5" for each component. The values are only passed over.
void FrdReader::read_field_header()
{
  FrdField found{.step = step_, .time = number(12, "the time of a field")};
  found.state = static_cast<int>(integer(58, 5, "the number of an increment"));
  if (found.step == 0) found.step = found.state;
  set_width();
  next_in("fields");
  if (field(0, n_key) != "-4") fail("a field begins with -4");
  found.name = field(5, 8);
  const bool is_of_nodes = field(18, 5) == "1";
  for (next_in("fields"); field(0, n_key) == "-5"; next_in("fields"))
    found.n_components += field(33, 5) == "1" ? 0 : 1;  // 1: is computed from the others
  found.place = lines_.before();
  found.width = width_;
  while (field(0, n_key) != "-3") next_in(fmt::format("values of {}", found.name));
  if (is_of_nodes) fields_.push_back(std::move(found));
}

/// Plane elements are those of plane problems; shells have the same numbers.
void FrdReader::check_elements() const
{
  const ImportedMesh& mesh = solution_.mesh;
  if (mesh.cells.empty()) throw InputError(where_, "the file has no elements", damaged);
  const auto is_plane = [](const ElementBlock& block) { return table_of(block.type.shape).dim == 2; };
  const auto plane = std::ranges::find_if(mesh.cells, is_plane);
  if (plane == mesh.cells.end()) return;
  const double z = mesh.nodes[plane->nodes[0]][2];
  double size = 0;
  bool is_flat = std::ranges::all_of(mesh.cells, is_plane);
  for (const Point<3>& x : mesh.nodes) size = std::max(size, x.lpNorm<Eigen::Infinity>());
  for (const ElementBlock& block : mesh.cells)
    for (const Index v : block.nodes) is_flat = is_flat && std::abs(mesh.nodes[v][2] - z) <= 1e-5 * size;
  if (!is_flat)
    throw InputError(where_, fmt::format("element {} is a shell", plane->numbers[0]),
                     "shells have no counterpart: solids only, or in 2D plane elements only");
}

/// The last one of the step.
const FrdField* FrdReader::last(const std::string& name) const
{
  const FrdField* found = nullptr;
  for (const FrdField& field : fields_)
    if (field.name == name && (!choice_.step || field.step == *choice_.step)) found = &field;
  return found;
}

std::string FrdReader::all_fields() const
{
  std::vector<std::string> words;
  for (const FrdField& field : fields_)
    if (std::string word = fmt::format("{} (step {})", field.name, field.step);
        std::ranges::find(words, word) == words.end())
      words.push_back(std::move(word));
  return words.empty() ? "the file has no fields of nodes"
                       : fmt::format("the file has {}", fmt::join(words, ", "));
}

/// Calls put(place of the node, values) for each node that has some.
template <std::size_t n, class Put>
void FrdReader::read_values(const FrdField& field_to_read, const Put& put)
{
  if (field_to_read.n_components != n)
    throw InputError(
        where_,
        fmt::format("{} has {} components, not {}", field_to_read.name, field_to_read.n_components, n),
        "a displacement has 3 (DISP), a stress 6 (STRESS)");
  width_ = field_to_read.width;
  lines_.go_to(field_to_read.place);
  std::vector<char> is_there(solution_.mesh.nodes.size(), 0);
  for (next_in("values"); field(0, n_key) != "-3"; next_in("values"))
  {
    if (field(0, n_key) != "-1") fail("the values of a node begin with -1");
    const std::int64_t number_of_node = integer(n_key, width_, "the number of a node");
    const Index place = node(number_of_node, field_to_read.name);
    if (std::exchange(is_there[place], 1) != 0)
      fail(fmt::format("node {} is there twice in {}", number_of_node, field_to_read.name));
    std::array<double, n> values{};
    for (std::size_t i = 0; i < n; ++i) values[i] = number(n_key + width_ + 12 * i, "a value");
    put(place, values);
  }
}

void FrdReader::read_displacement(const FrdField& displacement)
{
  solution_.displacement.assign(solution_.mesh.nodes.size(), no_displacement);
  read_values<3>(displacement, [&](Index node, const std::array<double, 3>& values)
                 { solution_.displacement[node] = displacement_of(values); });
}

/// That of the same increment.
void FrdReader::read_stress(int state)
{
  const std::string name = choice_.stress.empty() ? "STRESS" : choice_.stress;
  const auto found = std::ranges::find_if(
      fields_, [&](const FrdField& field) { return field.name == name && field.state == state; });
  if (found == fields_.end())
  {
    if (choice_.stress.empty()) return;
    throw InputError(where_, fmt::format("there is no {} in increment {}: {}", name, state, all_fields()),
                     "*EL FILE with S writes STRESS");
  }
  solution_.stress.assign(solution_.mesh.nodes.size(), no_stress);
  read_values<6>(*found, [&](Index node, const StressValues& values)
                 { solution_.stress[node] = finite_stress(values); });
}

ImportedSolution FrdReader::read()
{
  while (lines_.next())
  {
    const std::string_view key = field(0, 6);
    if (key == "2C") read_nodes();
    if (key == "3C") read_elements();
    if (key == "1PSTEP") step_ = static_cast<int>(integer(48, 12, "the number of a step"));
    if (key == "100C") read_field_header();
  }
  check_elements();
  const std::string name = choice_.field.empty() ? "DISP" : choice_.field;
  const FrdField* displacement = last(name);
  if (!displacement)
    throw InputError(where_,
                     fmt::format("there is no {}{}: {}", name,
                                 choice_.step ? fmt::format(" of step {}", *choice_.step) : "", all_fields()),
                     "*NODE FILE with U writes DISP");
  read_displacement(*displacement);
  read_stress(displacement->state);
  std::vector<std::string> types;
  for (const ElementBlock& block : solution_.mesh.cells)
    types.push_back(table_of(block.type.shape).dim == 3 ? fmt::format("C3D{}", block.type.n_nodes)
                                                        : describe(block.type));
  solution_.description = fmt::format("CalculiX results, step {} (t = {:g}), {}", displacement->step,
                                      displacement->time, fmt::join(types, ", "));
  return std::move(solution_);
}

}  // namespace

ImportedSolution read_frd(const std::filesystem::path& file, const SolutionChoice& choice)
{
  return FrdReader(file, choice).read();
}

}  // namespace tribound::mesh
