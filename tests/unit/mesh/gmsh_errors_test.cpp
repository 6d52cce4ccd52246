/// Files that must be refused, with required parts of the message.

#include <algorithm>

#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::Directory;
using testing_mesh::expect_input_error;
using testing_mesh::message_of;

/// An MSH 2.2 file from its nodes ("x y z") and its elements (without their numbers).
std::string msh(const std::vector<std::string>& nodes, const std::vector<std::string>& elements,
                const std::string& names = "")
{
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n" + std::to_string(nodes.size()) + "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i) text += std::to_string(i + 1) + " " + nodes[i] + "\n";
  text += "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + "\n";
  for (std::size_t i = 0; i < elements.size(); ++i) text += std::to_string(i + 1) + " " + elements[i] + "\n";
  return text + "$EndElements\n";
}

const std::vector<std::string> square = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
const std::string names =
    "$PhysicalNames\n3\n2 1 \"steel\"\n2 2 \"rubber\"\n1 3 \"foot\"\n$EndPhysicalNames\n";

const std::string rectangle_geo = R"(
Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {1, 1, 0, 1}; Point(4) = {0, 1, 0, 1};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
)";

struct BadFile
{
  std::string name;
  std::string file;
  std::string content;
  std::vector<std::string> words;
};

void PrintTo(const BadFile& bad, std::ostream* out)
{
  *out << bad.name;
}

class BadMesh : public testing::TestWithParam<BadFile>
{
};

TEST_P(BadMesh, IsRefused)
{
  const Directory directory;
  const mesh::MeshFile source = directory.write(GetParam().file, GetParam().content);
  std::vector<std::string> messages;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  for (int attempt = 0; attempt < 2; ++attempt)
    messages.push_back(message_of([&] { (void)mesh::read_mesh(source); }));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(messages[0], messages[1]) << "the first failure has left a trace";
  EXPECT_THAT(messages[0], testing::HasSubstr(GetParam().file));
  for (const std::string& word : GetParam().words) EXPECT_THAT(messages[0], testing::HasSubstr(word));
}

INSTANTIATE_TEST_SUITE_P(
    Gmsh, BadMesh,
    testing::ValuesIn(std::vector<BadFile>{
        {"UnknownSuffix", "block.cas", "solid", {"case.toml:3: mesh.file: ", "is of no format that is read"}},
        {"Empty", "block.msh", "", {"case.toml:3", "is empty"}},
        {"NoMesh", "block.msh", "hello\n", {"case.toml:3", "is not a .msh", "$MeshFormat"}},
        {"UnknownVersion",
         "block.msh",
         "$MeshFormat\n9.3 0 8\n$EndMeshFormat\n",
         {"Gmsh cannot read the file"}},
        {"CutOff", "block.msh", msh(square, {"2 2 1 1 1 2 3"}).substr(0, 60), {"block.msh: "}},
        {"CutOffInElements",
         "block.msh",
         msh(square, {"2 2 1 1 1 2 3", "2 2 1 1 1 3 4"}).substr(0, 112),
         {"block.msh: "}},
        {"UnknownNode", "block.msh", msh(square, {"2 2 1 1 1 2 9"}), {"Gmsh cannot read the file"}},
        {"SyntaxError",
         "block.geo",
         "Point(1) = {0, 0;\n",
         {"Gmsh cannot read the file", "line 1", "syntax error"}},
        {"UnknownPoint",
         "block.geo",
         "Point(1) = {0, 0, 0};\nLine(1) = {1, 2};\n",
         {"Gmsh cannot", "point 2"}},
        {"NoCells", "block.geo", "Point(1) = {0, 0, 0};\n", {"neither plane elements nor solids"}},
        {"OnlyLines",
         "block.msh",
         msh(square, {"1 2 1 1 1 2"}),
         {"neither plane elements nor solids", "a meshed surface"}},
        {"Polygon", "block.msh", msh(square, {"138 2 1 1 1 2 3 4"}), {"block.msh: "}},
        {"FifthOrder",
         "block.geo",
         rectangle_geo + "Mesh.ElementOrder = 5;\n",
         {"not read (Triangle 21, order 5)", "straight", "Mesh.ElementOrder = 1 or 2"}},
        {"NotConvex",
         "block.msh",
         msh({"0.4 0.4 0", "1 0 0", "0 0 0", "0 1 0"}, {"3 2 1 1 3 2 1 4", "3 2 1 1 1 2 3 4"}),
         {"element 2 (quadrilateral of 4 nodes) of region \"1\", whose triangle with corners",
          "is inverted"}},
        {"MixedOrders",
         "block.msh",
         msh({"0 0 0", "1 0 0", "1 1 0", "0.5 0 0"}, {"2 2 1 1 1 2 3", "8 2 3 1 1 2 4"}, names),
         {"elements of order 1 and of order 2", "of one order"}},
        {"NodeOfOrderTwoNotInThePlane",
         "block.msh",
         msh({"0 0 0", "1 0 0", "1 1 0", "0.5 0 0.1", "1 0.5 0", "0.5 0.5 0"}, {"9 2 1 1 1 2 3 4 5 6"}),
         {"node 4 at (0.5, 0, 0.1)", "z = 0"}},
        {"NotInThePlane",
         "block.msh",
         msh({"0 0 0", "1 0 0", "1 1 0.5"}, {"2 2 1 1 1 2 3"}),
         {"node 3 at (1, 1, 0.5)", "z = 0"}},
        {"NoGroup",
         "block.geo",
         rectangle_geo +
             "Translate {2, 0, 0} { Duplicata { Surface{1}; } }\nPhysical Surface(\"steel\") = {1};\n",
         {"4 of 8 elements are in no physical group", "surface", "corners (2"}},
        {"TwoGroups",
         "block.geo",
         rectangle_geo + "Physical Surface(\"steel\") = {1}; Physical Surface(\"rubber\") = {1};\n",
         {"surface 1 is in two physical groups", "\"steel\"", "\"rubber\""}},
        {"TwoBoundaryGroups",
         "block.geo",
         rectangle_geo + "Physical Curve(\"top\") = {1, 2}; Physical Curve(\"side\") = {2, 3};\n",
         {"curve 2 is in two physical groups", "\"top\"", "\"side\""}},
        {"SharedElementaryTag",
         "block.msh",
         msh(square, {"2 2 1 7 1 2 3", "2 2 2 7 1 3 4"}, names),
         {"surface 7 is in two physical groups", "elementary tags"}},
        {"MixedOrientation",
         "block.msh",
         msh(square, {"2 2 1 1 1 2 3", "2 2 1 1 1 4 3"}, names),
         {"element 2 (triangle of 3 nodes) of region \"steel\"", "inverted"}},
        {"BoundaryInside",
         "block.msh",
         msh(square, {"2 2 1 1 1 2 3", "2 2 1 1 1 3 4", "1 2 3 1 1 3"}, names),
         {"of group \"foot\" lies inside the domain"}},
        {"BoundaryElsewhere",
         "block.msh",
         msh(square, {"2 2 1 1 1 2 3", "1 2 3 1 1 4"}, names),
         {"of group \"foot\"", "block.msh: "}},
        {"Unmerged",
         "block.msh",
         msh({"0 0 0", "1 0 0", "1 1 0", "0 0 0", "1 1 0", "0 1 0"}, {"2 2 1 1 1 2 3", "2 2 1 1 4 5 6"},
             names),
         {"vertices 0 and 3 are both at (0, 0)", "Coherence"}},
        {"EmptyGroup",
         "block.msh",
         "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 5 "
         "\"foot\"\n$EndPhysicalNames\n$Entities\n0 1 1 0\n"
         "1 0 0 0 1 1 0 1 5 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 "
         "0 0\n0 1 0\n"
         "$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
         {"physical group \"foot\" has no edges"}},
        {"NumberBeyond32Bits",  // Gmsh crashes
         "block.msh",
         msh(square, {"2 2 1 1 1 2 3", "2 2 1 1 1 3 4"}).replace(114, 1, "2147483648"),
         {"block.msh: Gmsh cannot read the file: it was ended by signal", "numbered", "Mesh.Renumber"}},
        {"CrossingCurves",  // Gmsh ends the process
         "block.geo",
         "Point(1)={0,0,0,.3};Point(2)={1,1,0,.3};Point(3)={1,0,0,.3};Point(4)={0,1,0,.3};\n"
         "Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};\n"
         "Curve Loop(1)={1,2,3,4};Plane Surface(1)={1};\n",
         {"Gmsh cannot mesh the geometry: Unable to recover the edge", "curves or surfaces cross"}},
        {"PointAtInfinity",  // Gmsh does not end
         "block.geo",
         rectangle_geo + "Point(5) = {1e400, 0, 0, 1};\n",
         {"block.geo: point 5 of the geometry is at (inf, 0, 0), which are not finite numbers"}},
        {"PointBeyondAllLengths",  // Gmsh does not end
         "block.geo",
         rectangle_geo + "Point(5) = {-36, -1e308, 0, 1};\n",
         {"block.geo: point 5 of the geometry is at (-36, -1e+308, 0), beyond 1e+60"}},
        {"NoNewline",
         "block.geo",
         rectangle_geo + "Physical Surface(\"steel\") = {1};",
         {"newline", "last statement"}},
    }),
    [](const auto& info) { return info.param.name; });

#ifndef __SANITIZE_ADDRESS__  // its malloc ends the program where others return null
/// A binary MSH 4.1 file: a surface bounded by this many curves, which do not exist.
std::string binary_entities_with(std::uint64_t n_curves)
{
  std::string text = "$MeshFormat\n4.1 1 8\n";
  const auto put = [&text](auto value)
  { text.append(std::string_view(reinterpret_cast<const char*>(&value), sizeof(value))); };
  put(int{1});
  text += "\n$EndMeshFormat\n$Entities\n";
  for (const std::uint64_t n : {0, 0, 1, 0}) put(n);
  put(int{1});
  for (const double x : {0., 0., 0., 1., 1., 0.}) put(x);
  put(std::uint64_t{0});
  put(n_curves);
  return text + "\n$EndEntities\n";
}

INSTANTIATE_TEST_SUITE_P(
    GmshMemory, BadMesh,
    testing::ValuesIn(std::vector<BadFile>{
        {"TooManyNodes",  // Gmsh allocates space for them
         "block.msh",
         "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 0\n1 0 0 0 0\n$EndEntities\n"
         "$Nodes\n1 1000000000 1 1000000000\n0 1 0 1000000000\n1\n$EndNodes\n",
         {"block.msh: Gmsh needs more than 0.256 GB of memory, too much for a sound file of 0.00013",
          "the file is damaged", "save the mesh again"}},
        {"TooManyElements",
         "block.msh",
         "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 0\n1 0 0 0 0\n$EndEntities\n"
         "$Nodes\n1 1 1 1\n0 1 0 1\n1\n0 0 0\n$EndNodes\n"
         "$Elements\n1 1000000000 1 1000000000\n0 1 15 1000000000\n1 1\n$EndElements\n",
         {"block.msh: Gmsh needs more than 0.256 GB of memory", "a number of entities, nodes or elements"}},
        {"TooManyCurvesOfASurface",  // 2^31, in binary
         "block.msh",
         binary_entities_with(1U << 31U),
         {"block.msh: Gmsh needs more than 0.256 GB of memory", "the file is damaged"}},
    }),
    [](const auto& info) { return info.param.name; });
#endif

TEST(Gmsh, AMissingFileIsNamedWhereTheCaseAsksForIt)
{
  expect_input_error(
      []
      {
        (void)mesh::read_mesh(
            mesh::MeshFile{"nowhere/block.msh", {.file = "case.toml", .key = "mesh.file", .line = 3}});
      },
      {"case.toml:3: mesh.file: mesh file \"nowhere/block.msh\" does not exist", "relative to"});
}

/// A loop of 10^9 iterations, during which Gmsh is silent.
TEST(Gmsh, WaitsOnlySoLongForASignOfProgress)
{
  const Directory directory;
  const mesh::MeshFile source = directory.write("loop.geo", "For i In {1:1000000000}\nEndFor\n");
  std::vector<std::string> notes;
  expect_input_error([&] { (void)mesh::read_imported(source, nullptr, 0.3, notes); },
                     {"loop.geo: Gmsh shows no progress for 0.3 s and was ended", "apt install gmsh"});
}

TEST(Gmsh, CanBeInterrupted)
{
  const Directory directory;
  const mesh::MeshFile source = directory.write("loop.geo", "For i In {1:1000000000}\nEndFor\n");
  const std::atomic<bool> stop = true;
  EXPECT_THROW((void)mesh::read_mesh(source, {}, &stop), SolveError);
}

TEST(Gmsh, ADirectoryIsNotAFile)
{
  const Directory directory;
  std::filesystem::create_directory(directory / "block.msh");
  expect_input_error(
      [&] {
        (void)mesh::read_mesh(mesh::MeshFile{directory / "block.msh", {}});
      },
      {"is a directory"});
}

}  // namespace

}  // namespace tribound
