/// @file certify_bench.cpp
/// CPU time per cell and working memory of equilibration and estimation, and per segment of the additional
/// work for contact, for one body on an obstacle and for two with non-matching meshes. See bench/README.md.

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/block.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/bound/transfer.h"
#include "tribound/certify/bound/transfer_terms.h"
#include "tribound/certify/energy/admissible_stress.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/fem/degree.h"

namespace
{

using namespace tribound;
using bench::Block;

/// The block of these arguments, kept until another one is requested.
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

/// Maximal growth of the resident memory during `work`, in bytes.
template <class Work>
double peak_growth(Work work)
{
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // forgets the former peak
  const double before = status_bytes("VmRSS");
  work();
  return status_bytes("VmHWM") - before;
}

/// Seconds are summed over all threads, so that values per cell are those of one core.
void count_per_cell(benchmark::State& state, double n_cells)
{
  using benchmark::Counter;
  state.counters["per_cell"] = Counter(n_cells, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["cells"] = n_cells;
}

constexpr auto rows = certify::PatchStress::rows;
constexpr auto afw = certify::PatchStress::afw;

template <int dim, certify::PatchStress patches>
void equilibration(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const int threads = static_cast<int>(state.range(3));
  const auto equilibrated = [&] { return certify::equilibrate<dim>(b.form, b.u, b.t, threads, 0, patches); };
  double stress_bytes = 0;
  const double peak = peak_growth(
      [&]
      {
        const certify::Stress<dim> stress = equilibrated();
        stress_bytes = 8.0 * (stress.dis.size() + stress.lin.size());
      });
  for (auto _ : state) benchmark::DoNotOptimize(equilibrated());
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

/// The nearest admissible stress of every cell, given sigma_h; sigma(v) is 0, which costs as much as any
/// other.
template <int dim>
void admissible_stress(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t, 0, 0, afw);
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

/// Per segment of Gamma_C.
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

/// mor, and str_mor except for the values of sigma_dis - sigma(u).
template <int dim>
void transfer(benchmark::State& state)
{
  const Block<dim>& b = block<dim>(state);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(b.form, b.u, b.t);
  const certify::ContactTerms<dim> terms(b.form, certify::ContactRule::resolved);
  const auto field = [](const Point<dim>&) -> Tensor<dim> { return Tensor<dim>::Identity(); };
  for (auto _ : state)
    for (const auto& [cell, transfers] :
         certify::facet_transfers<dim>(b.form, terms, stress.tractions.running()))
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

// Counters are per CPU second of one thread, or per second of wall time where threads are compared.
BENCHMARK(equilibration<2, rows>)
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2, 3, 4}, {0, 1}, {1, 2}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<2, afw>)
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2, 3, 4}, {0, 1}, {1, 2}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3, rows>)
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2, 3}, {0, 1}, {1, 2}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3, afw>)
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2, 3}, {0, 1}, {1, 2}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<2, rows>)
    ->Name("equilibration<2>/wall")
    ->ArgNames({"p", "distorted", "bodies", "threads"})
    ->ArgsProduct({{1, 2}, {1}, {1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(equilibration<3, rows>)
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

BENCHMARK_MAIN();
