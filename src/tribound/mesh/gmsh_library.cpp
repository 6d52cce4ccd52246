#include "tribound/mesh/gmsh_library.h"

#include <dlfcn.h>
#include <gmshc.h>

#include <atomic>
#include <cassert>
#include <new>
#include <numbers>
#include <type_traits>

namespace tribound::mesh::gmsh
{

namespace
{

/// The handle of dlopen(); kept until the process ends.
void* library = nullptr;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

/// Gmsh's C interface turns exceptions into an error number; this records a lack of memory.
std::atomic<bool> memory_was_short = false;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

[[noreturn]] void report_short_memory()
{
  memory_was_short = true;
  throw std::bad_alloc();
}

/// Calls a function of the C interface, such as symbol<decltype(gmshOpen)>("gmshOpen").
template <typename Function, typename... Arguments>
auto call(const char* name, Arguments... arguments)
{
  auto* function = reinterpret_cast<Function*>(::dlsym(library, name));
  if (function == nullptr) throw GmshError(std::string("Gmsh's library has no ") + name);
  int error = 0;
  const auto check = [&]
  {
    if (error != 0 && memory_was_short.exchange(false)) throw std::bad_alloc();
    if (error != 0) throw GmshError(std::string(name) + " has failed");
  };
  if constexpr (std::is_void_v<std::invoke_result_t<Function, Arguments..., int*>>)
  {
    function(arguments..., &error);
    check();
  }
  else
  {
    const auto result = function(arguments..., &error);
    check();
    return result;
  }
}

/// Memory that Gmsh has allocated for its answer.
template <typename T>
struct Answer
{
  T* data = nullptr;
  std::size_t size = 0;

  Answer() = default;
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;
  ~Answer()
  {
    const auto free = reinterpret_cast<decltype(&gmshFree)>(::dlsym(library, "gmshFree"));
    if constexpr (std::is_pointer_v<T>)
      for (std::size_t i = 0; i < size; ++i) free(data[i]);
    free(data);
  }

  [[nodiscard]] std::vector<T> values() const { return {data, data + size}; }
};

std::vector<Entity> pairs(const Answer<int>& flat)
{
  std::vector<Entity> result;
  for (std::size_t i = 0; i + 1 < flat.size; i += 2) result.emplace_back(flat.data[i], flat.data[i + 1]);
  return result;
}

// Versions after 4.8 have more parameters in some functions.

template <typename Function, typename... Arguments>
constexpr bool takes = std::is_invocable_v<Function, Arguments..., int*>;

template <typename Function>
void initialize_as()
{
  if constexpr (takes<Function, int, char**, int>)
    call<Function>("gmshInitialize", 0, nullptr, 0);
  else  // and whether to run
    call<Function>("gmshInitialize", 0, nullptr, 0, 0);
}

template <typename Function>
void renumber_nodes_as()
{
  if constexpr (takes<Function>)
    call<Function>("gmshModelMeshRenumberNodes");
  else  // old and new numbers: all
    call<Function>("gmshModelMeshRenumberNodes", nullptr, std::size_t{0}, nullptr, std::size_t{0});
}

template <typename Function>
void classify_surfaces_as(double angle)
{
  constexpr const char* name = "gmshModelMeshClassifySurfaces";
  // With boundaries, in patches that can be parametrised; curves are not cut.
  if constexpr (takes<Function, double, int, int, double>)
    call<Function>(name, angle, 1, 1, std::numbers::pi);
  else  // and whether the triangles become geometry at once
    call<Function>(name, angle, 1, 1, std::numbers::pi, 0);
}

template <typename Function>
int element_type_as(std::size_t element)
{
  Answer<std::size_t> nodes;
  int type = 0;
  if constexpr (takes<Function, std::size_t, int*, std::size_t**, std::size_t*>)
    call<Function>("gmshModelMeshGetElement", element, &type, &nodes.data, &nodes.size);
  else  // and where it is
  {
    int dim = 0;
    int entity = 0;
    call<Function>("gmshModelMeshGetElement", element, &type, &nodes.data, &nodes.size, &dim, &entity);
  }
  return type;
}

}  // namespace

std::string load()
{
  // The first as the dynamic linker finds it, the other where the build has found it.
  for (const char* name : {TRIBOUND_GMSH_SONAME, TRIBOUND_GMSH_LIBRARY})
    if (library == nullptr) library = ::dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) return ::dlerror();
  std::set_new_handler(report_short_memory);
  return {};
}

std::string version()
{
  return GMSH_API_VERSION;
}

void initialize()
{
  initialize_as<decltype(gmshInitialize)>();
}

void open(const std::string& file)
{
  call<decltype(gmshOpen)>("gmshOpen", file.c_str());
}

void set_number(const std::string& option, double value)
{
  call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", option.c_str(), value);
}

void set_string(const std::string& option, const std::string& value)
{
  call<decltype(gmshOptionSetString)>("gmshOptionSetString", option.c_str(), value.c_str());
}

void start_logger()
{
  call<decltype(gmshLoggerStart)>("gmshLoggerStart");
}

std::vector<std::string> log()
{
  Answer<char*> lines;
  call<decltype(gmshLoggerGet)>("gmshLoggerGet", &lines.data, &lines.size);
  return {lines.data, lines.data + lines.size};
}

int dimension()
{
  return call<decltype(gmshModelGetDimension)>("gmshModelGetDimension");
}

std::vector<Entity> entities(int dim)
{
  Answer<int> flat;
  call<decltype(gmshModelGetEntities)>("gmshModelGetEntities", &flat.data, &flat.size, dim);
  return pairs(flat);
}

std::string entity_name(const Entity& entity)
{
  Answer<char> name;
  call<decltype(gmshModelGetEntityName)>("gmshModelGetEntityName", entity.first, entity.second, &name.data);
  return name.data;
}

std::size_t n_bounded(const Entity& entity)
{
  Answer<int> upward;
  Answer<int> downward;
  call<decltype(gmshModelGetAdjacencies)>("gmshModelGetAdjacencies", entity.first, entity.second,
                                          &upward.data, &upward.size, &downward.data, &downward.size);
  return upward.size;
}

Box bounding_box()
{
  Box box{};
  auto& [a, b] = box;
  call<decltype(gmshModelGetBoundingBox)>("gmshModelGetBoundingBox", -1, -1, a.data(), a.data() + 1,
                                          a.data() + 2, b.data(), b.data() + 1, b.data() + 2);
  return box;
}

std::vector<double> position(int point)
{
  Answer<double> x;
  call<decltype(gmshModelGetValue)>("gmshModelGetValue", 0, point, nullptr, std::size_t{0}, &x.data, &x.size);
  return x.values();
}

std::vector<Entity> physical_groups(int dim)
{
  Answer<int> flat;
  call<decltype(gmshModelGetPhysicalGroups)>("gmshModelGetPhysicalGroups", &flat.data, &flat.size, dim);
  return pairs(flat);
}

std::string physical_name(const Entity& group)
{
  Answer<char> name;
  call<decltype(gmshModelGetPhysicalName)>("gmshModelGetPhysicalName", group.first, group.second, &name.data);
  return name.data;
}

std::vector<int> entities_of(const Entity& group)
{
  Answer<int> tags;
  call<decltype(gmshModelGetEntitiesForPhysicalGroup)>("gmshModelGetEntitiesForPhysicalGroup", group.first,
                                                       group.second, &tags.data, &tags.size);
  return tags.values();
}

void fill_surface(double angle)
{
  classify_surfaces_as<decltype(gmshModelMeshClassifySurfaces)>(angle);
  call<decltype(gmshModelMeshCreateGeometry)>("gmshModelMeshCreateGeometry", nullptr, std::size_t{0});
  std::vector<int> surfaces;
  for (const Entity& surface : entities(2)) surfaces.push_back(surface.second);
  int shell = call<decltype(gmshModelGeoAddSurfaceLoop)>("gmshModelGeoAddSurfaceLoop", surfaces.data(),
                                                         surfaces.size(), -1);
  call<decltype(gmshModelGeoAddVolume)>("gmshModelGeoAddVolume", &shell, std::size_t{1}, -1);
  call<decltype(gmshModelGeoSynchronize)>("gmshModelGeoSynchronize");
}

void generate(int dim)
{
  call<decltype(gmshModelMeshGenerate)>("gmshModelMeshGenerate", dim);
}

void renumber_nodes()
{
  renumber_nodes_as<decltype(gmshModelMeshRenumberNodes)>();
}

Nodes nodes(int dim)
{
  Answer<std::size_t> tags;
  Answer<double> x;
  Answer<double> parameters;
  call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags.data, &tags.size, &x.data, &x.size,
                                        &parameters.data, &parameters.size, dim, -1, 0, 0);
  return {tags.values(), x.values()};
}

std::vector<int> element_types(int dim)
{
  Answer<int> types;
  call<decltype(gmshModelMeshGetElementTypes)>("gmshModelMeshGetElementTypes", &types.data, &types.size, dim,
                                               -1);
  return types.values();
}

ElementType element_properties(int type)
{
  Answer<char> name;
  Answer<double> corners;
  int dim = 0;
  int order = 0;
  int n_nodes = 0;
  int n_primary = 0;
  call<decltype(gmshModelMeshGetElementProperties)>("gmshModelMeshGetElementProperties", type, &name.data,
                                                    &dim, &order, &n_nodes, &corners.data, &corners.size,
                                                    &n_primary);
  return {name.data, order};
}

int element_type(std::size_t element)
{
  return element_type_as<decltype(gmshModelMeshGetElement)>(element);
}

std::vector<std::size_t> elements(int type)
{
  using Preallocate = decltype(gmshModelMeshPreallocateElementsByType);
  Answer<std::size_t> tags;
  Answer<std::size_t> no_nodes;
  call<Preallocate>("gmshModelMeshPreallocateElementsByType", type, 1, 0, &tags.data, &tags.size,
                    &no_nodes.data, &no_nodes.size, -1);
  if (tags.size == 0) return {};
  call<decltype(gmshModelMeshGetElementsByType)>("gmshModelMeshGetElementsByType", type, &tags.data,
                                                 &tags.size, &no_nodes.data, &no_nodes.size, -1,
                                                 std::size_t{0}, std::size_t{1});
  return tags.values();
}

Elements elements_in(int type, int entity)
{
  Answer<std::size_t> tags;
  Answer<std::size_t> nodes;
  call<decltype(gmshModelMeshGetElementsByType)>("gmshModelMeshGetElementsByType", type, &tags.data,
                                                 &tags.size, &nodes.data, &nodes.size, entity, std::size_t{0},
                                                 std::size_t{1});
  return {tags.values(), nodes.values()};
}

std::vector<View> views()
{
  Answer<int> tags;
  call<decltype(gmshViewGetTags)>("gmshViewGetTags", &tags.data, &tags.size);
  std::vector<View> result;
  for (const int tag : tags.values())
  {
    const std::string view =
        "View[" + std::to_string(call<decltype(gmshViewGetIndex)>("gmshViewGetIndex", tag)) + "].";
    Answer<char> name;
    double n_steps = 0;
    call<decltype(gmshOptionGetString)>("gmshOptionGetString", (view + "Name").c_str(), &name.data);
    call<decltype(gmshOptionGetNumber)>("gmshOptionGetNumber", (view + "NbTimeStep").c_str(), &n_steps);
    result.push_back({name.data, tag, static_cast<int>(n_steps)});
  }
  return result;
}

ModelData model_data(const View& view, int step)
{
  Answer<char> kind;
  Answer<std::size_t> tags;
  Answer<double*> values;
  Answer<std::size_t> n_values;
  ModelData data{};
  call<decltype(gmshViewGetModelData)>("gmshViewGetModelData", view.tag, step, &kind.data, &tags.data,
                                       &tags.size, &values.data, &n_values.data, &values.size, &data.time,
                                       &data.n_components);
  data.kind = kind.data;
  data.tags = tags.values();
  for (std::size_t i = 0; i < values.size; ++i)
    data.values.emplace_back(values.data[i], values.data[i] + n_values.data[i]);
  return data;
}

}  // namespace tribound::mesh::gmsh
