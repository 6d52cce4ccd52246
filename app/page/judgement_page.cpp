#include "app/page/judgement_page.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "app/output_directory.h"
#include "app/page/packed_array.h"
#include "app/page/page_level.h"
#include "app/result/judged_steps.h"
#include "app/result/judgement.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/nested.h"
#include "tribound/io/record/record_json.h"
#include "tribound/mesh/overlay.h"

namespace tribound::app
{

namespace
{

constexpr int distance_bits = 12;
constexpr double distance_decades = 8;
/// Ours is finer than their cells. Both surfaces are on the page.
constexpr PageLimits limits{.degree = 4, .subdivided = 12'000, .triangles = 120'000, .stresses = 12'000};

/// A displacement on a mesh that comes from `mesh` by bisect(), at points of the cells of `mesh`.
template <int dim>
class NestedDisplacement
{
 public:
  NestedDisplacement(const mesh::Mesh<dim>& mesh, const fem::LagrangeSpace<dim>& space,
                     std::span<const double> u)
      : space_(space), u_(u), pairs_(mesh::overlay(mesh, space.mesh()))
  {
  }

  [[nodiscard]] Point<dim> value(Index cell, const Point<dim>& x) const
  {
    const Place at = place(cell, x);
    return fem::value_at<dim>(space_.cell_nodes(at.cell), u_, tabulate(at).values_at(0));
  }
  [[nodiscard]] Tensor<dim> gradient(Index cell, const Point<dim>& x) const
  {
    const Place at = place(cell, x);
    return fem::gradient_at<dim>(space_.cell_nodes(at.cell), u_, tabulate(at).gradients_at(0),
                                 mesh::cell_map(space_.mesh(), at.cell).inverse_transpose);
  }

 private:
  struct Place
  {
    Index cell = 0;
    Point<dim> xhat = Point<dim>::Zero();
  };

  /// The part of the cell that contains x: the one where its smallest barycentric coordinate is the largest.
  [[nodiscard]] Place place(Index cell, const Point<dim>& x) const
  {
    Place best;
    double inside = -std::numeric_limits<double>::infinity();
    for (auto pair = std::ranges::lower_bound(pairs_, cell, {}, &mesh::CellPair::a);
         pair != pairs_.end() && pair->a == cell; ++pair)
    {
      const Point<dim> xhat = fem::reference_point(mesh::cell_map(space_.mesh(), pair->b), x);
      const double least = std::min(xhat.minCoeff(), 1 - xhat.sum());
      if (least <= inside) continue;
      inside = least;
      best = {pair->b, xhat};
    }
    return best;
  }

  [[nodiscard]] fem::Tabulation<dim> tabulate(const Place& at) const
  {
    return space_.basis().tabulate(std::span(&at.xhat, 1));
  }

  const fem::LagrangeSpace<dim>& space_;
  std::span<const double> u_;
  std::vector<mesh::CellPair> pairs_;  ///< ascending in their first cell
};

/// Its values at the nodes of a space on the coarser mesh.
template <int dim>
std::vector<double> at_nodes(const fem::LagrangeSpace<dim>& space,
                             const NestedDisplacement<dim>& displacement)
{
  std::vector<double> values(space.n_dofs());
  std::vector<char> is_known(space.n_nodes(), 0);
  for (Index cell = 0; cell < space.mesh().n_cells(); ++cell)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), cell);
    for (int i = 0; i < space.basis().n_nodes(); ++i)
    {
      const Index node = space.cell_nodes(cell)[i];
      if (is_known[node]++ != 0) continue;
      const Point<dim> u = displacement.value(cell, map(space.basis().node_point(i)));
      std::ranges::copy(u, values.begin() + dim * static_cast<std::ptrdiff_t>(node));
    }
  }
  return values;
}

/// u_r / r at a node of a cell, with the gradient of u there.
template <int dim>
double hoop_strain(const NestedDisplacement<dim>& displacement, const fem::LagrangeSpace<dim>& lattice,
                   Index cell, int i, const Tensor<dim>& gradient)
{
  double r = 0;  // without rounding on the axis
  for (int v = 0; v <= dim; ++v)
    r += lattice.basis().node(i)[v] * lattice.mesh().vertex(lattice.mesh().cell(cell)[v])[0] /
         lattice.degree();
  const Point<dim> x = mesh::cell_map(lattice.mesh(), cell)(lattice.basis().node_point(i));
  return contact::hoop_strain(r, displacement.value(cell, x)[0], gradient(0, 0));
}

/// Its stress, with the initial one.
template <int dim>
StressAt<dim> stress_of(const problem::Problem<dim>& problem, const NestedDisplacement<dim>& displacement)
{
  return [&](const fem::LagrangeSpace<dim>& lattice) -> io::TensorField<dim>
  {
    io::TensorField<dim> field{
        "stress", [&](Index cell, std::span<Tensor<dim>> values)
        {
          const int region = lattice.mesh().region(cell);
          const mesh::CellMap<dim> map = mesh::cell_map(lattice.mesh(), cell);
          for (std::size_t i = 0; i < values.size(); ++i)
          {
            const auto node = static_cast<int>(i);
            const Point<dim> x = map(lattice.basis().node_point(node));
            const Tensor<dim> gradient = displacement.gradient(cell, x);
            values[i] = problem.is_axisymmetric()
                            ? contact::sigma<dim>(problem.material(region), gradient,
                                                  hoop_strain(displacement, lattice, cell, node, gradient))
                            : contact::sigma<dim>(problem.material(region), gradient);
            if (problem.regions()[region].has_initial_stress())
              values[i] += problem.initial_stress(region, x);
          }
        }};
    if (problem.is_axisymmetric())
      field.hoop = [&](Index cell, std::span<double> values)
      {
        const mesh::CellMap<dim> map = mesh::cell_map(lattice.mesh(), cell);
        for (int i = 0; i < std::ssize(values); ++i)
        {
          const Tensor<dim> gradient = displacement.gradient(cell, map(lattice.basis().node_point(i)));
          values[i] = io::added_around_axis(problem.material(lattice.mesh().region(cell)),
                                            hoop_strain(displacement, lattice, cell, i, gradient));
        }
      };
    return field;
  };
}

/// The stress that was read, by its values at the nodes of the cells of their space.
template <int dim>
StressAt<dim> stress_read(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                          const certify::ForeignSolution<dim>& theirs)
{
  return [&](const fem::LagrangeSpace<dim>& lattice) -> io::TensorField<dim>
  {
    const fem::Tabulation<dim> table = space.basis().tabulate(lattice.basis().node_points());
    const auto at = [table](Index cell, int q, const auto& nodal, auto value)
    {
      const auto n_nodes = static_cast<std::size_t>(table.n_nodes);
      for (std::size_t i = 0; i < n_nodes; ++i) value += table.values_at(q)[i] * nodal[n_nodes * cell + i];
      return value;
    };
    io::TensorField<dim> field{"stress", [&theirs, at](Index cell, std::span<Tensor<dim>> values)
                               {
                                 for (int q = 0; q < std::ssize(values); ++q)
                                   values[q] = at(cell, q, theirs.stress, Tensor<dim>(Tensor<dim>::Zero()));
                               }};
    if (!theirs.hoop.empty())  // what zz has beside that of plane strain
      field.hoop = [&problem, &space, &theirs, at](Index cell, std::span<double> values)
      {
        const double ratio = io::out_of_plane_ratio(problem.material(space.mesh().region(cell)));
        for (int q = 0; q < std::ssize(values); ++q)
          values[q] = at(cell, q, theirs.hoop, 0.0) -
                      ratio * at(cell, q, theirs.stress, Tensor<dim>(Tensor<dim>::Zero())).trace();
      };
    return field;
  };
}

io::Json distance_json(const Surface& surface, const certify::JudgedField& field)
{
  std::vector<double> values;
  for (const Index cell : surface.cells) values.push_back(field.cells[cell]);
  return pack_logarithmic(values, distance_bits, distance_decades);
}

/// Per face: 2 in a cell to be refined, else 1 in the core of the error, else 0.
io::Json place_json(const Surface& surface, const certify::JudgedField& field)
{
  std::vector<Index> of_cell(field.cells.size(), 0);
  std::vector<double> descending = field.cells;
  std::ranges::sort(descending, std::greater());
  if (const std::size_t n = field.core.n_cells; n > 0)
    for (std::size_t c = 0; c < of_cell.size(); ++c) of_cell[c] = field.cells[c] >= descending[n - 1] ? 1 : 0;
  for (const Index cell : field.halving) of_cell[cell] = 2;
  std::vector<Index> places;
  for (const Index cell : surface.cells) places.push_back(of_cell[cell]);
  return pack_integers(places);
}

}  // namespace

template <int dim>
io::Json judged_surfaces(const contact::NitscheForm<dim>& form, const certify::ForeignSolution<dim>& theirs,
                         const certify::Judgement& judgement, const fem::LagrangeSpace<dim>& space,
                         std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const NestedDisplacement<dim> their_displacement(mesh, form.space(), theirs.u);
  const NestedDisplacement<dim> our_displacement(mesh, space, u);
  const StressAt<dim> their_stress = theirs.stress.empty()
                                         ? stress_of(form.problem(), their_displacement)
                                         : stress_read<dim>(form.problem(), form.space(), theirs);
  const Surface shown = sample_surface<dim>(form, theirs.u, their_stress, limits);
  const Surface ours = sample_surface<dim>(form, at_nodes(form.space(), our_displacement),
                                           stress_of(form.problem(), our_displacement), limits);
  io::Json json{{"theirs", surface_json(form, shown)},
                {"ours", surface_json(form, ours)},
                {"contact_faces", shown.contact.pressure.size() / shown.n_face_points()},
                {"distance", distance_json(shown, judgement.displacement)},
                {"place", place_json(shown, judgement.displacement)}};
  if (judgement.stress) json["stress_distance"] = distance_json(shown, *judgement.stress);
  return json;
}

void write_judgement_page(const PageTemplate& page, const std::filesystem::path& directory,
                          std::span<const JudgementRecord> steps, const io::Json& surfaces)
{
  const std::size_t worst = worst_step(steps);
  std::vector<std::string> files = {"judgement.json", "judged_cells.csv", "judged.vtu", "report.html"};
  for (const char* name : {"judged_cells.csv", "judged.vtu"})
    files.push_back((judged_step_directory(worst) / name).string());
  io::Json data{{"judgement", judgement_object(steps[worst])},
                {"program", io::program_json(io::build_facts())},
                {"machine", machine_json()},
                {"files", files_json(directory, files)},
                {"surfaces", surfaces}};
  if (steps.size() > 1) data["of_steps"] = judged_steps_object(steps);
  page.write(directory / "judgement.html", "judgement-data", data);
}

template io::Json judged_surfaces(const contact::NitscheForm<2>&, const certify::ForeignSolution<2>&,
                                  const certify::Judgement&, const fem::LagrangeSpace<2>&,
                                  std::span<const double>);
template io::Json judged_surfaces(const contact::NitscheForm<3>&, const certify::ForeignSolution<3>&,
                                  const certify::Judgement&, const fem::LagrangeSpace<3>&,
                                  std::span<const double>);

}  // namespace tribound::app
