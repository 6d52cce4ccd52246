#pragma once

/// @file gmsh_library.h
/// Gmsh's library, loaded on demand: with its geometry kernel and its windows it takes longer to start than
/// many cases take to solve. Declares the functions used here, by the names they have in Gmsh's own
/// interfaces. Each throws GmshError where Gmsh reports a failure.

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tribound::mesh::gmsh
{

/// What failed; the reason is in log().
class GmshError : public std::runtime_error
{
 public:
  using std::runtime_error::runtime_error;
};

/// Loads the library; once is enough. No other function may be called before. Returns why it cannot be
/// loaded, or an empty text.
[[nodiscard]] std::string load();
/// The version whose interface is used, such as "4.8.0".
[[nodiscard]] std::string version();

void initialize();
void open(const std::string& file);
void set_number(const std::string& option, double value);
void set_string(const std::string& option, const std::string& value);

void start_logger();
[[nodiscard]] std::vector<std::string> log();

/// Dimension and tag.
using Entity = std::pair<int, int>;

[[nodiscard]] int dimension();
[[nodiscard]] std::vector<Entity> entities(int dim);
/// The label of an entity of a CAD file, "Shapes/part/bolt"; empty: none.
[[nodiscard]] std::string entity_name(const Entity& entity);
/// How many entities of the next dimension it bounds.
[[nodiscard]] std::size_t n_bounded(const Entity& entity);
struct Box
{
  std::array<double, 3> lower;
  std::array<double, 3> upper;
};
/// Around the whole geometry.
[[nodiscard]] Box bounding_box();
/// The coordinates of a point of the geometry.
[[nodiscard]] std::vector<double> position(int point);
[[nodiscard]] std::vector<Entity> physical_groups(int dim);
[[nodiscard]] std::string physical_name(const Entity& group);
/// Tags of the entities of a group, negative where an entity is reversed.
[[nodiscard]] std::vector<int> entities_of(const Entity& group);

/// Makes surfaces of the triangles that are loaded, cut at edges sharper than `angle` (radians), and one
/// volume inside them all.
void fill_surface(double angle);
/// Meshes the geometry up to this dimension.
void generate(int dim);
void renumber_nodes();

struct Nodes
{
  std::vector<std::size_t> tags;
  std::vector<double> x;  ///< 3 coordinates each
};

/// Nodes of the entities of one dimension without their boundaries; dim = -1: all nodes.
[[nodiscard]] Nodes nodes(int dim = -1);

/// The types of the elements of this dimension.
[[nodiscard]] std::vector<int> element_types(int dim);

struct ElementType
{
  std::string name;
  int order;
};

[[nodiscard]] ElementType element_properties(int type);
[[nodiscard]] int element_type(std::size_t element);
/// Tags of the elements of a type, without reading their nodes.
[[nodiscard]] std::vector<std::size_t> elements(int type);
struct Elements
{
  std::vector<std::size_t> tags;
  std::vector<std::size_t> nodes;  ///< tags, element by element
};

/// The elements of a type in an entity.
[[nodiscard]] Elements elements_in(int type, int entity);

struct View
{
  std::string name;
  int tag;
  int n_steps;
};

/// The fields that come with a mesh.
[[nodiscard]] std::vector<View> views();

/// A step of a view on the mesh.
struct ModelData
{
  std::string kind;               ///< "NodeData", "ElementData", "ElementNodeData"
  std::vector<std::size_t> tags;  ///< of nodes or elements
  std::vector<std::vector<double>> values;
  double time;
  int n_components;
};

[[nodiscard]] ModelData model_data(const View& view, int step);

}  // namespace tribound::mesh::gmsh
