#pragma once

/// @file frd_mesh.h
/// Nodes and elements of CalculiX's results.

#include <unordered_map>

#include "tribound/mesh/import/frd_records.h"
#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

class FrdMesh
{
 public:
  explicit FrdMesh(FrdRecords& records) : records_(records) {}

  /// Behind the records 2C and 3C.
  void read_nodes();
  void read_elements();
  /// Throws InputError where there are none, and where there are shells.
  void check() const;

  [[nodiscard]] const ImportedMesh& mesh() const { return mesh_; }
  /// The place of the node with the number; `of` is what has it.
  [[nodiscard]] Index node(std::int64_t number, std::string_view of) const;

 private:
  void read_element(std::size_t width);

  FrdRecords& records_;
  ImportedMesh mesh_{.source = records_.where()};
  std::unordered_map<std::int64_t, Index> node_of_number_{};
};

}  // namespace tribound::mesh
