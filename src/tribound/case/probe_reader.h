#pragma once

/// @file probe_reader.h
/// [probe.NAME] and [section.NAME]: where a solution is read.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"
#include "tribound/io/record/observations.h"
#include "tribound/mesh/mesh.h"

namespace tribound::case_file
{

[[nodiscard]] const Table& probes_table();
[[nodiscard]] const Table& sections_table();

/// One entry for each table.
[[nodiscard]] std::vector<ProbeConfig> read_probes(const Node& table);
[[nodiscard]] std::vector<SectionConfig> read_sections(const Node& table);

/// The probes and sections of the case on its first mesh. Throws InputError for vectors of wrong length, for
/// points outside the mesh, and for planes that cut no cell. All ranks call it together.
template <int dim>
[[nodiscard]] io::Observations<dim> observations(const Config& config, const mesh::Mesh<dim>& mesh);

}  // namespace tribound::case_file
