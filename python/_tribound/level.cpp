#include "python/_tribound/level.h"

#include <pybind11/stl.h>

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "python/_tribound/arrays.h"
#include "python/_tribound/mesh.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/io/fields/contact_line.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/io/record/level_json.h"
#include "tribound/io/record/observations_json.h"
#include "tribound/io/record/probes.h"
#include "tribound/io/record/sections.h"

namespace tribound::python
{

namespace py = pybind11;

namespace
{

template <int dim>
Point<dim> to_point(const std::vector<double>& x)
{
  if (x.size() != dim)
    throw InputError({}, "has another dimension than the mesh", "one number per dimension");
  Point<dim> point;
  std::ranges::copy(x, point.begin());
  return point;
}

template <int dim>
bool has_stress(const Level<dim>& level)
{
  return level.kept->level.stress.degree > 0;
}

/// The field at the nodes of all cells of this rank, (cells, nodes, 6).
template <int dim>
py::array_t<double> at_nodes(const Level<dim>& level, const io::TensorField<dim>& field)
{
  const fem::LagrangeSpace<dim>& space = level.kept->discrete->space;
  const auto n_nodes = static_cast<std::size_t>(space.basis().n_nodes());
  const Index n_cells = space.mesh().n_owned_cells();
  std::vector<std::array<double, 6>> values(n_nodes * n_cells);
  for (Index c = 0; c < n_cells; ++c)
    io::symmetric_at_nodes<dim>(level.kept->discrete->form.problem(), space, field, c,
                                std::span(values).subspan(n_nodes * c, n_nodes));
  return owned(flat(values), {n_cells, static_cast<py::ssize_t>(n_nodes), 6});
}

template <int dim>
py::array_t<double> stress(const Level<dim>& level)
{
  const adapt::Discretisation<dim>& discrete = *level.kept->discrete;
  return at_nodes<dim>(level,
                       io::stress_field<dim>(discrete.form.problem(), discrete.space, level.kept->level.u));
}

template <int dim>
py::object equilibrated_stress(const Level<dim>& level)
{
  if (!has_stress(level)) return py::none();
  return at_nodes<dim>(
      level, io::equilibrated_stress_field<dim>(level.kept->discrete->space, level.kept->level.stress));
}

template <int dim>
py::array_t<int> cell_node_indices(const Level<dim>& level)
{
  const fem::LagrangeBasis<dim>& basis = level.kept->discrete->space.basis();
  std::vector<int> indices;
  for (int i = 0; i < basis.n_nodes(); ++i)
    indices.insert(indices.end(), basis.node(i).begin(), basis.node(i).end());
  return owned(std::move(indices), {basis.n_nodes(), dim + 1});
}

/// One row for each point and each region that has it.
template <int dim>
py::dict probe(const Level<dim>& level, const std::vector<std::vector<double>>& points)
{
  io::Probe<dim> probe{.name = "probe", .points = {}, .where = {.key = "at"}};
  for (const std::vector<double>& x : points) probe.points.push_back(to_point<dim>(x));
  const std::array probes{probe};
  io::check_probes<dim>(level.kept->discrete->mesh, probes);
  const std::vector<io::ProbeRow> rows =
      io::read_probes<dim>(level.kept->discrete->form, level.kept->level, has_stress(level), probes)
          .front()
          .rows;
  std::vector<long> numbers;
  std::vector<double> displacement;
  std::vector<double> sigma;
  std::vector<double> equilibrated;
  std::vector<std::string> regions;
  std::vector<std::string> bodies;
  for (const io::ProbeRow& row : rows)
  {
    numbers.push_back(static_cast<long>(row.point));
    displacement.insert(displacement.end(), row.u.begin(), row.u.end());
    sigma.insert(sigma.end(), row.stress.begin(), row.stress.end());
    if (row.equilibrated)
      equilibrated.insert(equilibrated.end(), row.equilibrated->begin(), row.equilibrated->end());
    regions.push_back(row.region);
    bodies.push_back(row.body);
  }
  const auto n = static_cast<py::ssize_t>(rows.size());
  py::dict result;
  result["point"] = owned(std::move(numbers), {n});
  result["displacement"] = owned(std::move(displacement), {n, dim});
  result["stress"] = owned(std::move(sigma), {n, 6});
  result["equilibrated_stress"] =
      has_stress(level) ? py::object(owned(std::move(equilibrated), {n, 6})) : py::object(py::none());
  result["region"] = regions;
  result["body"] = bodies;
  return result;
}

/// As in `sections` of the certificate, JSON.
template <int dim>
std::string section(const Level<dim>& level, const std::vector<double>& point,
                    const std::vector<double>& normal, const std::string& within)
{
  io::Section<dim> plane{.name = "section",
                         .point = to_point<dim>(point),
                         .normal = to_point<dim>(normal),
                         .where = {.key = "section"}};
  if (plane.normal.norm() == 0) throw InputError(plane.where, "has a normal without length", "a direction");
  if (!has_stress(level))
    throw InputError(plane.where, "needs the equilibrated stress of a bound", "another level");
  plane.normal.normalize();
  if (!within.empty()) plane.within.emplace(within, plane.where);
  const std::array planes{plane};
  io::check_sections<dim>(level.kept->discrete->mesh, planes);
  io::LevelRecord record;
  record.sections = io::read_sections<dim>(level.kept->discrete->form, level.kept->level, planes);
  io::Json object = io::Json::object();
  io::add_observations(object, record);
  return object["sections"][0].dump();
}

/// The cell of each facet or segment of the contact, by the numbers of contact.csv.
template <int dim>
py::array_t<Index> contact_cells(const Level<dim>& level)
{
  std::vector<Index> cells;
  for (const auto& segment : level.kept->discrete->form.segments()) cells.push_back(segment.slave.facet.cell);
  const auto n = static_cast<py::ssize_t>(cells.size());
  return owned(std::move(cells), {n});
}

template <int dim>
py::dict cell_errors(const Level<dim>& level)
{
  py::dict errors;
  for (auto& [name, values] : level.kept->cell_components())
  {
    const auto n = static_cast<py::ssize_t>(values.size());
    errors[py::str(name)] = owned(std::move(values), {n});
  }
  return errors;
}

template <int dim>
void bind(py::module_& module, const char* name)
{
  using L = Level<dim>;
  const auto space = [](const L& level) -> const fem::LagrangeSpace<dim>&
  { return level.kept->discrete->space; };
  py::class_<L>(module, name)
      .def_property_readonly("dimension", [](const L&) { return dim; })
      .def_property_readonly("degree", [space](const L& level) { return space(level).degree(); })
      .def_property_readonly("number", [](const L& level) { return level.kept->number; })
      .def_property_readonly("t", [](const L& level) { return level.kept->t; })
      .def_property_readonly("record", [](const L& level) { return level.record; })
      .def_property_readonly("bound", [](const L& level) { return level.kept->level.estimate.total_sharp; })
      .def_property_readonly("sigma_norm", [](const L& level) { return level.kept->level.norms.sigma; })
      .def("mesh_arrays", [](const py::object& self)
           { return mesh_arrays<dim>(self.cast<const L&>().kept->discrete->mesh, self); })
      .def("nodes",
           [space](const L& level) {
             return owned(flat(space(level).node_points()), {space(level).n_nodes(), dim});
           })
      .def("cell_nodes",
           [space](const py::object& self)
           {
             const fem::LagrangeSpace<dim>& of = space(self.cast<const L&>());
             return view(of.cell_nodes(0).data(), {of.mesh().n_owned_cells(), of.basis().n_nodes()}, self);
           })
      .def("cell_node_indices", &cell_node_indices<dim>)
      .def("displacement",
           [space](const py::object& self)
           {
             const L& level = self.cast<const L&>();
             return view(level.kept->level.u.data(), {space(level).n_nodes(), dim}, self);
           })
      .def("stress", &stress<dim>)
      .def("equilibrated_stress", &equilibrated_stress<dim>)
      .def("cell_errors", &cell_errors<dim>)
      .def("contact_csv",
           [](const L& level) {
             return io::contact_csv<dim>(level.kept->discrete->form, level.kept->level.u,
                                         level.kept->place());
           })
      .def("contact_cells", &contact_cells<dim>)
      .def("probe", &probe<dim>, py::arg("points"))
      .def("section", &section<dim>, py::arg("point"), py::arg("normal"), py::arg("within") = "");
}

}  // namespace

template <int dim>
Level<dim> to_level(const std::shared_ptr<const app::KeptLevel<dim>>& kept, const io::LevelRecord& record)
{
  io::Json object = io::level_json(record);
  if (record.balance) object["balance"] = io::balance_json(*record.balance);
  return {kept, object.dump()};
}

template Level<2> to_level(const std::shared_ptr<const app::KeptLevel<2>>&, const io::LevelRecord&);
template Level<3> to_level(const std::shared_ptr<const app::KeptLevel<3>>&, const io::LevelRecord&);

void bind_levels(py::module_& module)
{
  bind<2>(module, "Level2");
  bind<3>(module, "Level3");
}

}  // namespace tribound::python
