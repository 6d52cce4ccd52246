#pragma once

/// Shared by the tests of meshes: files that vanish after the test, errors with expected words, measures, a
/// mesh without symmetry.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string>

#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/mesh.h"

namespace tribound::testing_mesh
{

/// A separate directory for every test and process, so that tests can run side by side.
class Directory
{
 public:
  Directory()
  {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            ("tribound_" + std::to_string(::getpid()) + "_" + test->test_suite_name() + "_" + test->name());
    std::filesystem::create_directories(path_);
  }
  ~Directory() { std::filesystem::remove_all(path_); }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  [[nodiscard]] mesh::MeshFile write(const std::string& name, const std::string& text) const
  {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return {path_ / name, {.file = "case.toml", .key = "mesh.file", .line = 3}};
  }

 private:
  std::filesystem::path path_;
};

using test::message_of;

/// `action` throws InputError whose text has all the given parts.
template <class Action>
void expect_input_error(const Action& action, std::initializer_list<std::string> parts)
{
  const std::string message = message_of(action);
  for (const std::string& part : parts) EXPECT_THAT(message, ::testing::HasSubstr(part));
}

/// Reads a file that may be damaged: whether it gives a mesh; otherwise expects a message with the file.
inline bool gives_mesh_or_message(const mesh::MeshFile& file)
{
  try
  {
    (void)mesh::read_mesh(file);
    return true;
  }
  catch (const InputError& error)
  {
    EXPECT_NE(error.problem(), "");
    EXPECT_NE(error.where().file, "");
    return false;
  }
}

template <int dim>
double volume(const mesh::Mesh<dim>& mesh)
{
  double sum = 0.0;
  for (Index c = 0; c < mesh.n_cells(); ++c) sum += mesh::cell_map(mesh, c).det / (dim == 2 ? 2 : 6);
  return sum;
}

/// The measure of a boundary group.
template <int dim>
double boundary_measure(const mesh::Mesh<dim>& mesh, int tag)
{
  double sum = 0.0;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.tag == tag) sum += mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
  return sum;
}

/// The smallest angle between two edges of a triangle or two faces of a tetrahedron, degrees.
template <int dim>
double smallest_angle(const mesh::Mesh<dim>& mesh)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int i = 0; i <= dim; ++i)
      for (int j = i + 1; j <= dim; ++j)
      {
        const double cosine =
            -mesh::facet_geometry(mesh, c, i).normal.dot(mesh::facet_geometry(mesh, c, j).normal);
        smallest = std::min(smallest, std::acos(cosine) * 180 / std::numbers::pi);
      }
  return smallest;
}

/// A few squares or cubes.
template <int dim>
mesh::MeshData<dim> grid()
{
  if constexpr (dim == 2)
    return test::box<2>({0, 0}, {2, 1}, {3, 2});
  else
    return test::box<3>({0, 0, 0}, {2, 1, 1}, {2, 2, 1});
}

/// Two regions, a boundary group in pieces, a part of the boundary in no group, all cells different.
template <int dim>
mesh::MeshData<dim> irregular_data()
{
  mesh::MeshData<dim> data = grid<dim>();
  data.region_names.push_back("inclusion");
  for (std::size_t c = 0; c < data.cells.size(); c += 3) data.regions[c] = 1;
  std::erase_if(data.facets, [](const mesh::TaggedFacet<dim>& facet) { return facet.tag == 1; });
  data.source = {.file = "grid.msh"};
  return test::distorted(std::move(data), 3);
}

template <int dim>
mesh::Mesh<dim> irregular_mesh()
{
  return mesh::Mesh<dim>(irregular_data<dim>());
}

}  // namespace tribound::testing_mesh
