#pragma once

/// What the tests of meshes share: files that vanish after the test, errors with expected words, measures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

#include "mesh/geometry.h"
#include "mesh/gmsh.h"
#include "mesh/mesh.h"

namespace tribound::testing_mesh
{

/// A directory of its own for every test and process, so that tests can run side by side.
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

  [[nodiscard]] MeshFile write(const std::string& name, const std::string& text) const
  {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return {path_ / name, {.file = "case.toml", .key = "mesh.file", .line = 3}};
  }

 private:
  std::filesystem::path path_;
};

/// The text of the InputError that `action` throws, or empty.
template <class Action>
std::string message_of(const Action& action)
{
  try
  {
    action();
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return {};
}

/// `action` throws InputError whose text has all the given parts.
template <class Action>
void expect_input_error(const Action& action, std::initializer_list<std::string> parts)
{
  const std::string message = message_of(action);
  for (const std::string& part : parts) EXPECT_THAT(message, ::testing::HasSubstr(part));
}

template <int dim>
double volume(const Mesh<dim>& mesh)
{
  double sum = 0.0;
  for (Index c = 0; c < mesh.n_cells(); ++c) sum += cell_map(mesh, c).det / (dim == 2 ? 2 : 6);
  return sum;
}

/// The measure of a boundary group.
template <int dim>
double boundary_measure(const Mesh<dim>& mesh, int tag)
{
  double sum = 0.0;
  for (const BoundaryFacet& facet : mesh.boundary())
    if (facet.tag == tag) sum += facet_geometry(mesh, facet.cell, facet.local).measure;
  return sum;
}

}  // namespace tribound::testing_mesh
