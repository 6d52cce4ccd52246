/// @file certify_bench.cpp
/// CPU time per cell and working memory of equilibration and estimation, per segment of what contact adds to
/// them, of one body on an obstacle and of two whose meshes do not match. See bench/README.md.

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tribound/algebra/petsc.h"
#include "tribound/base/clock.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/bound/transfer.h"
#include "tribound/certify/bound/transfer_terms.h"
#include "tribound/certify/energy/admissible_stress.h"
#include "tribound/certify/energy/balanced_solution.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/fem/degree.h"
#include "tribound/mesh/box.h"

namespace
{

using namespace tribound;

/// Squares or cubes across the height of the box, such that it has 100k triangles or tetrahedra; fewer
/// tetrahedra at higher degrees.
template <int dim>
int cells_across(int degree)
{
  if constexpr (dim == 2) return 158;                 // 99 856 triangles
  constexpr std::array tetrahedra = {20, 16, 11, 7};  // 96 000, 49 152, 15 972, 4 116
  return tetrahedra[degree - 1];
}

/// How far two bodies are apart, so that a point tells on which of them it is; the gap is given as 0.
constexpr double apart = 0.01;

/// The block (0, 2) x (0, 1) [x (0, 1)] with n squares or cubes across; or with about as many cells in all
/// two of its size, one below the other, the lower one with a square or cube less across.
template <int dim>
mesh::Boxes blocks(int n, int bodies)
{
  if (bodies == 2) n = static_cast<int>(std::lround(n / std::pow(2.0, 1.0 / dim)));
  mesh::BoxMesh block{{0, 0}, {2, 1}, {2 * n, n}, {}};
  if constexpr (dim == 3) block = {{0, 0, 0}, {2, 1, 1}, {2 * n, n, n}, {}};
  mesh::Boxes result = {{"upper", block}};
  if (bodies == 1) return result;
  block.lower[1] = -1 - apart;
  block.upper[1] = -apart;
  block.cells = {2 * (n - 1), n - 1};
  if constexpr (dim == 3) block.cells.push_back(n - 1);
  result.push_back({"lower", block});
  return result;
}

/// Moves the vertices inside the boxes by up to a fifth of the mesh size: no two cells keep the same shape.
template <int dim>
void distort(mesh::MeshData<dim>& data, const mesh::Boxes& boxes)
{
  std::mt19937 generator(1);
  const double most = 0.2 / boxes[0].box.cells[1];
  std::uniform_real_distribution<double> shift(-most, most);
  for (Point<dim>& x : data.vertices)
  {
    const bool inside =
        std::ranges::any_of(boxes,
                            [&](const mesh::NamedBox& named)
                            {
                              const Eigen::Map<const Point<dim>> lower(named.box.lower.data());
                              const Eigen::Map<const Point<dim>> upper(named.box.upper.data());
                              return ((x - lower).array() > 1e-9).all() && ((upper - x).array() > 1e-9).all();
                            });
    for (int c = 0; c < dim; ++c)
      if (inside) x[c] += shift(generator);
  }
}

template <int dim>
mesh::Mesh<dim> block_mesh(int n, bool distorted, int bodies)
{
  const mesh::Boxes boxes = blocks<dim>(n, bodies);
  mesh::MeshData<dim> data = mesh::box_meshes<dim>(boxes);
  if (distorted) distort<dim>(data, boxes);
  return mesh::Mesh<dim>(std::move(data));
}

/// Clamped on the left, pressed with friction on a floor or on a second block that is clamped below.
template <int dim>
problem::Problem<dim> block_problem(const mesh::Mesh<dim>& mesh, int bodies)
{
  std::array<std::optional<problem::Field>, dim> zero;
  zero.fill(0.0);
  std::vector<problem::BoundaryCondition<dim>> conditions = {
      problem::with_displacement<dim>("upper.left", zero),
      problem::with_traction<dim>("upper.top", {0.0, -0.1})};
  std::vector<problem::ContactPair<dim>> pairs;
  const problem::Contact contact(problem::Tresca(0.03));
  if (bodies == 1)
    conditions.push_back(problem::with_contact<dim>("upper.bottom", contact.law));
  else
  {
    conditions.push_back(problem::with_displacement<dim>("lower.bottom", zero));
    pairs.push_back({.slave = {"upper.bottom"}, .master = {"lower.top"}, .contact = contact});
  }
  return problem::Problem<dim>(mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}}, conditions,
                               std::move(pairs));
}

/// A smooth displacement of the upper block and a traction that is not its own: what equilibrate() costs does
/// not depend on them, and the patch problems are solvable for any. The lower block stays where it is, so
/// that contact is that with the floor.
template <int dim>
struct Block
{
  Block(int degree, bool distorted, int bodies) : Block(degree, distorted, bodies, cells_across<dim>(degree))
  {
  }
  Block(int degree, bool distorted, int bodies, int across)
      : mesh(block_mesh<dim>(across, distorted, bodies)),
        problem(block_problem(mesh, bodies)),
        space(mesh, degree),
        form(problem, space, contact::default_gamma0(degree))
  {
    for (const Point<dim>& x : space.node_points())
      for (int c = 0; c < dim; ++c)
        u.push_back(x[1] < -apart / 2 ? 0
                                      : x[0] * (0.02 * std::sin(3 * x[0] + x[dim - 1] + c) - 0.03 * x[1]));
    t = form.traction(u);
    for (Point<dim>& traction : t) traction *= 1.1;
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  contact::NitscheForm<dim> form;
  std::vector<double> u;
  std::vector<Point<dim>> t;
};

/// The block of these arguments, kept until another one is asked for.
template <int dim>
const Block<dim>& block(const benchmark::State& state)
{
  static std::array<std::int64_t, 3> made{};
  static std::unique_ptr<Block<dim>> kept;
  const std::array asked{state.range(0), state.range(1), state.range(2)};
  if (!kept || made != asked)
  {
    kept.reset();
    kept =
        std::make_unique<Block<dim>>(static_cast<int>(asked[0]), asked[1] != 0, static_cast<int>(asked[2]));
    made = asked;
  }
  return *kept;
}

/// A field of /proc/self/status, in bytes.
double status_bytes(const std::string& field)
{
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (word == field + ":")
    {
      double kilobytes = 0;
      file >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

/// Bytes by which `work` makes the resident memory grow at its largest.
template <class Work>
double peak_growth(Work work)
{
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // forgets the former peak
  const double before = status_bytes("VmRSS");
  work();
  return status_bytes("VmHWM") - before;
}

/// Seconds are those of all threads together, so that they are per cell what they would be on one core.
void count_per_cell(benchmark::State& state, double n_cells)
{
  using benchmark::Counter;
  state.counters["per_cell"] = Counter(n_cells, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["cells"] = n_cells;
}

template <int dim>
void equilibration(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const int threads = static_cast<int>(state.range(3));
  double stress_bytes = 0;
  const double peak = peak_growth(
      [&]
      {
        const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t, threads);
        stress_bytes = 8.0 * (stress.dis.size() + stress.lin.size());
      });
  for (auto _ : state) benchmark::DoNotOptimize(certify::equilibrate<dim>(b.form, b.u, b.t, threads));
  count_per_cell(state, b.mesh.n_cells());
  state.counters["bytes"] = (peak - stress_bytes) / b.mesh.n_cells();
}

template <int dim>
void estimation(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t);
  for (auto _ : state) benchmark::DoNotOptimize(certify::estimate<dim>(b.form, b.u, stress));
  count_per_cell(state, b.mesh.n_cells());
}

template <int dim>
void both(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        certify::estimate<dim>(b.form, b.u, certify::equilibrate<dim>(b.form, b.u, b.t, 1)));
  count_per_cell(state, b.mesh.n_cells());
}

/// The nearest admissible stress of every cell, given sigma_h; sigma(v) is 0, which costs as much as any.
template <int dim>
void admissible_stress(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t);
  const std::size_t n = fem::polynomial_dimension(dim, stress.degree - 1);
  const std::vector<double> sigma_v(dim * dim * n);
  fem::with_degree(stress.degree,
                   [&](auto degree)
                   {
                     certify::AdmissibleStressSolver<dim, degree()> solver;
                     for (auto _ : state)
                       for (Index c = 0; c < b.mesh.n_cells(); ++c)
                         benchmark::DoNotOptimize(solver.solve(certify::make_sorted_cell(b.mesh, c),
                                                               b.problem.material(b.mesh.region(c)),
                                                               stress.dis_in(c), sigma_v));
                   });
  count_per_cell(state, b.mesh.n_cells());
}

/// CPU seconds of the work.
template <class Work>
double cpu_seconds_of(const Work& work)
{
  const double before = cpu_seconds();
  work();
  return cpu_seconds() - before;
}

/// u~ of the block, as the bound of the error in the energy norm needs it. For p = 1 the loads are those of
/// degree 2.
template <int dim>
class BalancedBlock
{
 public:
  explicit BalancedBlock(const Block<dim>& block)
      : block_(block),
        space_(block.mesh, std::max(block.space.degree(), 2)),
        form_(block.problem, space_, block.form.gamma0()),
        t_(form_.traction(certify::raised(block.space, block.u, space_))),
        motions_(block.problem, block.mesh)
  {
  }

  [[nodiscard]] std::vector<double> solve() const
  {
    const bool is_raised = block_.space.degree() < space_.degree();
    return certify::balanced_solution<dim>(form_, is_raised ? block_.space : space_, block_.u, t_, motions_,
                                           {});
  }

 private:
  const Block<dim>& block_;
  fem::LagrangeSpace<dim> space_;
  contact::NitscheForm<dim> form_;
  std::vector<Point<dim>> t_;
  certify::FreeMotions<dim> motions_;
};

/// The bound of the error in the energy norm with all that is made once for a mesh, without quantities;
/// beside it, in turn, its linear system alone, the equilibration of the same form, and the bound of the
/// residual. On a small block, where the system does not hide the rest.
template <int dim>
void energy_bound(benchmark::State& state)
{
  const Block<dim> b(static_cast<int>(state.range(0)), true, 1, static_cast<int>(state.range(1)));
  const BalancedBlock<dim> balanced(b);
  std::array<double, 4> seconds{};
  for (auto _ : state)
  {
    seconds[0] += cpu_seconds_of(
        [&]
        {
          const certify::EnergyBound bound = certify::EnergyEstimator<dim>(b.form, {})(b.u);
          if (!bound.reason.empty()) state.SkipWithError(bound.reason.c_str());
        });
    seconds[1] += cpu_seconds_of([&] { benchmark::DoNotOptimize(balanced.solve()); });
    seconds[2] +=
        cpu_seconds_of([&] { benchmark::DoNotOptimize(certify::equilibrate<dim>(b.form, b.u, b.t, 1)); });
    seconds[3] += cpu_seconds_of(
        [&]
        {
          benchmark::DoNotOptimize(
              certify::estimate<dim>(b.form, b.u, certify::equilibrate<dim>(b.form, b.u, b.t, 1)));
        });
  }
  const std::array names = {"bound", "system", "equilibration", "residual"};
  for (std::size_t i = 0; i < names.size(); ++i)
    state.counters[names[i]] = seconds[i] / (static_cast<double>(state.iterations()) * b.mesh.n_cells());
  state.counters["ratio"] = (seconds[0] - seconds[1]) / seconds[2];
  state.counters["cells"] = b.mesh.n_cells();
}

/// Of the segments of Gamma_C.
template <int dim>
void count_per_segment(benchmark::State& state, const Block<dim>& b)
{
  using benchmark::Counter;
  const auto n = static_cast<double>(b.form.segments().size());
  state.counters["per_segment"] = Counter(n, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["segments"] = n;
  state.counters["cells"] = b.mesh.n_cells();
}

/// cnt, frc, lin2n and lin2t.
template <int dim>
void contact_terms(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t);
  const certify::ContactTerms<dim> terms(b.form, certify::ContactRule::resolved);
  for (auto _ : state)
    for (std::size_t k = 0; k < b.form.segments().size(); ++k)
      benchmark::DoNotOptimize(terms(static_cast<int>(k), b.u, stress.tractions));
  count_per_segment(state, b);
}

/// mor, and str_mor but for the values of sigma_dis - sigma(u).
template <int dim>
void transfer(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t);
  const certify::ContactTerms<dim> terms(b.form, certify::ContactRule::resolved);
  const auto field = [](const Point<dim>&) -> Tensor<dim> { return Tensor<dim>::Identity(); };
  for (auto _ : state)
    for (const auto& [cell, transfers] : certify::facet_transfers<dim>(b.form, terms, stress.tractions))
      for (const certify::FacetTransfer<dim>& of_facet : transfers)
        for (const auto& pieces : of_facet.groups)
        {
          const certify::TransferLifting<dim> lifting(b.mesh, of_facet.facet, b.space.degree(), pieces);
          benchmark::DoNotOptimize(lifting.norm());
          benchmark::DoNotOptimize(lifting.change(field));
        }
  count_per_segment(state, b);
}

}  // namespace

// Counters are per CPU second of one thread, or per second on the wall where threads are compared.
BENCHMARK(equilibration<2>)
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2, 3, 4}, {0, 1}, {1, 2}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3>)
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2, 3}, {0, 1}, {1, 2}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<2>)
    ->Name("equilibration<2>/wall")
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2}, {1}, {1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3>)
    ->Name("equilibration<3>/wall")
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1}, {1}, {1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(estimation<2>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3, 4}, {1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(estimation<3>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3}, {1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(both<2>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3, 4}, {1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(both<3>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3}, {1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(admissible_stress<2>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{2, 3, 4}, {1}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(admissible_stress<3>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{2, 3, 4}, {1}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(energy_bound<2>)
    ->ArgNames({"p", "across"})
    ->ArgsProduct({{1, 2, 3, 4}, {32}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(energy_bound<3>)
    ->ArgNames({"p", "across"})
    ->ArgsProduct({{1, 2, 3}, {6}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(contact_terms<2>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3, 4}, {1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(contact_terms<3>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3}, {1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(transfer<2>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3, 4}, {1}, {2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(transfer<3>)
    ->ArgNames({"p", "distorted", "bodies"})
    ->ArgsProduct({{1, 2, 3}, {1}, {2}})
    ->Unit(benchmark::kMillisecond);

int main(int argc, char** argv)
{
  const tribound::algebra::Environment petsc;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
