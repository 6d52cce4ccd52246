/// @file certify_bench.cpp
/// CPU time per cell and working memory of equilibration and estimation. See bench/README.md.

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/penalty.h"
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

/// Moves the vertices inside the box by up to a fifth of the mesh size: no two cells keep the same shape.
template <int dim>
void distort(mesh::MeshData<dim>& data, int n)
{
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> shift(-0.2 / n, 0.2 / n);
  const Point<dim> lower = Point<dim>::Zero();
  Point<dim> upper = Point<dim>::Ones();
  upper[0] = 2;
  for (Point<dim>& x : data.vertices)
  {
    const bool inside = ((x - lower).array() > 1e-9).all() && ((upper - x).array() > 1e-9).all();
    for (int c = 0; c < dim; ++c)
      if (inside) x[c] += shift(generator);
  }
}

template <int dim>
mesh::Mesh<dim> block_mesh(int degree, bool distorted)
{
  const int n = cells_across<dim>(degree);
  mesh::BoxMesh box{{0, 0}, {2, 1}, {2 * n, n}, {}};
  if constexpr (dim == 3) box = {{0, 0, 0}, {2, 1, 1}, {2 * n, n, n}, {}};
  mesh::MeshData<dim> data = mesh::box_mesh<dim>(box);
  if (distorted) distort<dim>(data, n);
  return mesh::Mesh<dim>(std::move(data));
}

/// Clamped on the left, pressed on a floor with friction.
template <int dim>
problem::Problem<dim> block_problem(const mesh::Mesh<dim>& mesh)
{
  std::array<std::optional<problem::Field>, dim> zero;
  zero.fill(0.0);
  return problem::Problem<dim>(
      mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}},
      {problem::with_displacement<dim>("left", zero), problem::with_traction<dim>("top", {0.0, -0.1}),
       problem::with_contact<dim>("bottom", problem::Tresca(0.03))});
}

/// A smooth displacement and a traction that is not its own: what equilibrate() costs does not depend on
/// them, and the patch problems are solvable for any.
template <int dim>
struct Block
{
  Block(int degree, bool distorted)
      : mesh(block_mesh<dim>(degree, distorted)),
        problem(block_problem(mesh)),
        space(mesh, degree),
        form(problem, space, contact::default_gamma0(degree))
  {
    for (const Point<dim>& x : space.node_points())
      for (int c = 0; c < dim; ++c)
        u.push_back(x[0] * (0.02 * std::sin(3 * x[0] + x[dim - 1] + c) - 0.03 * x[1]));
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
  static std::pair<std::int64_t, std::int64_t> made{};
  static std::unique_ptr<Block<dim>> kept;
  const std::pair asked{state.range(0), state.range(1)};
  if (!kept || made != asked)
  {
    kept.reset();
    kept = std::make_unique<Block<dim>>(static_cast<int>(asked.first), asked.second != 0);
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
  const int threads = static_cast<int>(state.range(2));
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

}  // namespace

// Counters are per CPU second of one thread, or per second on the wall where threads are compared.
BENCHMARK(equilibration<2>)
    ->ArgNames({"p", "distorted", "threads"})
    ->ArgsProduct({{1, 2, 3, 4}, {0, 1}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3>)
    ->ArgNames({"p", "distorted", "threads"})
    ->ArgsProduct({{1, 2, 3}, {0, 1}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<2>)
    ->Name("equilibration<2>/wall")
    ->ArgNames({"p", "distorted", "threads"})
    ->ArgsProduct({{1, 2}, {1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3>)
    ->Name("equilibration<3>/wall")
    ->ArgNames({"p", "distorted", "threads"})
    ->ArgsProduct({{1}, {1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(estimation<2>)
    ->ArgNames({"p", "distorted"})
    ->ArgsProduct({{1, 2, 3, 4}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(estimation<3>)
    ->ArgNames({"p", "distorted"})
    ->ArgsProduct({{1, 2, 3}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(both<2>)
    ->ArgNames({"p", "distorted"})
    ->ArgsProduct({{1, 2, 3, 4}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(both<3>)
    ->ArgNames({"p", "distorted"})
    ->ArgsProduct({{1, 2, 3}, {1}})
    ->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
