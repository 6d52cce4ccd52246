#include "tribound/mesh/import/imported_bytes.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tribound::mesh
{

namespace
{

/// Appends values to a string of bytes.
class ByteWriter
{
 public:
  void put(std::size_t number) { append(&number, sizeof(number)); }
  void put(std::string_view text)
  {
    put(text.size());
    append(text.data(), text.size());
  }
  void put(const std::vector<std::string>& texts)
  {
    put(texts.size());
    for (const std::string& text : texts) put(std::string_view(text));
  }
  /// Plain data: numbers, and arrays of them.
  template <class T>
  void put(const std::vector<T>& values)
  {
    put(values.size());
    append(values.data(), values.size() * sizeof(T));
  }

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }

  std::string bytes_;
};

/// Extracts the values again, in the same order.
class ByteReader
{
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  void get(std::size_t& number) { extract(&number, sizeof(number)); }
  void get(std::string& text)
  {
    text.resize(size());
    extract(text.data(), text.size());
  }
  void get(std::vector<std::string>& texts)
  {
    texts.resize(size());
    for (std::string& text : texts) get(text);
  }
  template <class T>
  void get(std::vector<T>& values)
  {
    values.resize(size());
    extract(static_cast<void*>(values.data()), values.size() * sizeof(T));
  }

 private:
  std::size_t size()
  {
    std::size_t n = 0;
    get(n);
    return n;
  }
  void extract(void* to, std::size_t n)
  {
    if (n > 0) std::memcpy(to, bytes_.data(), n);
    bytes_.remove_prefix(n);
  }

  std::string_view bytes_;
};

/// The first number.
enum ImportedAnswer : std::size_t
{
  is_refused = 0,
  is_mesh = 1
};

void put(ByteWriter& bytes, const std::vector<ElementBlock>& blocks)
{
  bytes.put(blocks.size());
  for (const ElementBlock& block : blocks)
  {
    bytes.put(static_cast<std::size_t>(block.type.shape));
    bytes.put(static_cast<std::size_t>(block.type.n_nodes));
    bytes.put(block.nodes);
    bytes.put(block.numbers);
  }
}

void get(ByteReader& bytes, std::vector<ElementBlock>& blocks)
{
  std::size_t n = 0;
  bytes.get(n);
  blocks.resize(n);
  for (ElementBlock& block : blocks)
  {
    bytes.get(n);
    block.type.shape = static_cast<Shape>(n);
    bytes.get(n);
    block.type.n_nodes = static_cast<int>(n);
    bytes.get(block.nodes);
    bytes.get(block.numbers);
  }
}

/// Sets by their names, each with its members.
template <class Set, class Put>
void put_sets(ByteWriter& bytes, const std::vector<Set>& sets, const Put& put_members)
{
  bytes.put(sets.size());
  for (const Set& set : sets)
  {
    bytes.put(std::string_view(set.name));
    put_members(set);
  }
}

template <class Set, class Get>
void get_sets(ByteReader& bytes, std::vector<Set>& sets, const Get& get_members)
{
  std::size_t n = 0;
  bytes.get(n);
  sets.resize(n);
  for (Set& set : sets)
  {
    bytes.get(set.name);
    get_members(set);
  }
}

void put(ByteWriter& bytes, const ImportedMesh& mesh, const std::vector<std::string>& notes)
{
  bytes.put(is_mesh);
  bytes.put(notes);
  bytes.put(mesh.nodes);
  bytes.put(mesh.node_numbers);
  put(bytes, mesh.cells);
  put_sets(bytes, mesh.cell_sets, [&](const CellSet& set) { bytes.put(set.cells); });
  put_sets(bytes, mesh.facet_sets, [&](const FacetSet& set) { put(bytes, set.facets); });
  put_sets(bytes, mesh.node_sets,
           [&](const NodeSet& set)
           {
             bytes.put(set.nodes);
             bytes.put(static_cast<std::size_t>(set.has_facets ? 1 : 0));
           });
}

}  // namespace

std::string bytes_of(const ImportedMesh& mesh, const std::vector<std::string>& notes)
{
  ByteWriter bytes;
  put(bytes, mesh, notes);
  return bytes.take();
}

std::string bytes_of(const ImportedSolution& solution)
{
  ByteWriter bytes;
  put(bytes, solution.mesh, solution.notes);
  bytes.put(solution.displacement);
  bytes.put(solution.stress);
  bytes.put(static_cast<std::size_t>(solution.stress_of_elements ? 1 : 0));
  bytes.put(std::string_view(solution.description));
  bytes.put(solution.steps);
  return bytes.take();
}

std::string bytes_of(const InputError& error)
{
  ByteWriter bytes;
  bytes.put(is_refused);
  for (const int number : {error.where().line, error.where().column})
    bytes.put(static_cast<std::size_t>(number));
  for (const std::string& text : {error.where().file, error.where().key, error.problem(), error.hint()})
    bytes.put(std::string_view(text));
  return bytes.take();
}

namespace
{

ImportedMesh get_mesh(ByteReader& bytes, const Where& source, std::vector<std::string>& notes)
{
  std::size_t number = is_refused;
  bytes.get(number);
  if (number == is_refused)
  {
    Where where;
    std::string problem;
    std::string hint;
    for (int* place : {&where.line, &where.column})
    {
      bytes.get(number);
      *place = static_cast<int>(number);
    }
    for (std::string* text : {&where.file, &where.key, &problem, &hint}) bytes.get(*text);
    throw InputError(where, problem, hint);
  }
  std::vector<std::string> its_notes;
  bytes.get(its_notes);
  notes.insert(notes.end(), its_notes.begin(), its_notes.end());
  ImportedMesh mesh{.source = source};
  bytes.get(mesh.nodes);
  bytes.get(mesh.node_numbers);
  get(bytes, mesh.cells);
  get_sets(bytes, mesh.cell_sets, [&](CellSet& set) { bytes.get(set.cells); });
  get_sets(bytes, mesh.facet_sets, [&](FacetSet& set) { get(bytes, set.facets); });
  get_sets(bytes, mesh.node_sets,
           [&](NodeSet& set)
           {
             bytes.get(set.nodes);
             bytes.get(number);
             set.has_facets = number != 0;
           });
  return mesh;
}

}  // namespace

ImportedMesh mesh_from(std::string_view result, const Where& source, std::vector<std::string>& notes)
{
  ByteReader bytes(result);
  return get_mesh(bytes, source, notes);
}

ImportedSolution solution_from(std::string_view result, const Where& source)
{
  ByteReader bytes(result);
  ImportedSolution solution;
  solution.mesh = get_mesh(bytes, source, solution.notes);
  bytes.get(solution.displacement);
  bytes.get(solution.stress);
  std::size_t number = 0;
  bytes.get(number);
  solution.stress_of_elements = number != 0;
  bytes.get(solution.description);
  bytes.get(solution.steps);
  return solution;
}

}  // namespace tribound::mesh
