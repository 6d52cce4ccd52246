#pragma once

/// @file mesh_bytes.h
/// Imported meshes and errors as a string of bytes, to be passed between processes of the same program.

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
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

inline void put(ByteWriter& bytes, const std::vector<ElementBlock>& blocks)
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

/// All that Gmsh's reader fills in; the source is left to the caller.
inline void put(ByteWriter& bytes, const ImportedMesh& mesh)
{
  bytes.put(mesh.nodes);
  bytes.put(mesh.node_numbers);
  put(bytes, mesh.cells);
  bytes.put(mesh.cell_sets.size());
  for (const CellSet& set : mesh.cell_sets)
  {
    bytes.put(std::string_view(set.name));
    bytes.put(set.cells);
  }
  bytes.put(mesh.facet_sets.size());
  for (const FacetSet& set : mesh.facet_sets)
  {
    bytes.put(std::string_view(set.name));
    put(bytes, set.facets);
  }
}

inline void get(ByteReader& bytes, std::vector<ElementBlock>& blocks)
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

inline void get(ByteReader& bytes, ImportedMesh& mesh)
{
  std::size_t n = 0;
  bytes.get(mesh.nodes);
  bytes.get(mesh.node_numbers);
  get(bytes, mesh.cells);
  bytes.get(n);
  mesh.cell_sets.resize(n);
  for (CellSet& set : mesh.cell_sets)
  {
    bytes.get(set.name);
    bytes.get(set.cells);
  }
  bytes.get(n);
  mesh.facet_sets.resize(n);
  for (FacetSet& set : mesh.facet_sets)
  {
    bytes.get(set.name);
    get(bytes, set.facets);
  }
}

}  // namespace tribound::mesh
