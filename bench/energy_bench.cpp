/// @file energy_bench.cpp
/// CPU time per cell of the bound of the error in the energy norm, compared with the equilibration and the
/// bound of the residual. See bench/README.md.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bench/block.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/clock.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/energy/balanced_solution.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/equilibrate/equilibrate.h"

namespace
{

using namespace tribound;
using bench::Block;

/// CPU seconds of the work.
template <class Work>
double cpu_seconds_of(const Work& work)
{
  const double before = cpu_seconds();
  work();
  return cpu_seconds() - before;
}

/// u~ of the block for the bound of the error in the energy norm. For p = 1 the loads are those of degree 2.
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
    certify::ContactSystems<dim> systems(form_, {}, false);
    return certify::balanced_solution<dim>(form_, is_raised ? block_.space : space_, block_.u, t_, motions_,
                                           {}, systems);
  }

 private:
  const Block<dim>& block_;
  fem::LagrangeSpace<dim> space_;
  contact::NitscheForm<dim> form_;
  std::vector<Point<dim>> t_;
  certify::FreeMotions<dim> motions_;
};

/// The bound of the error in the energy norm with everything that is made once per mesh, without quantities.
/// For comparison, in turn: its linear system alone, the equilibration of the same form, and the bound of the
/// residual. The block is small, so that the system does not hide the rest. Two bodies have meshes that do
/// not match.
template <int dim>
void energy_bound(benchmark::State& state)
{
  const Block<dim> b(static_cast<int>(state.range(0)), true, static_cast<int>(state.range(2)),
                     static_cast<int>(state.range(1)));
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
    seconds[2] += cpu_seconds_of(
        [&] {
          benchmark::DoNotOptimize(
              certify::equilibrate<dim>(b.form, b.u, b.t, 1, 0, certify::PatchStress::afw));
        });
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

}  // namespace

BENCHMARK(energy_bound<2>)
    ->ArgNames({"p", "across", "bodies"})
    ->ArgsProduct({{1, 2, 3, 4}, {32}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(energy_bound<3>)
    ->ArgNames({"p", "across", "bodies"})
    ->ArgsProduct({{1, 2, 3}, {6}, {1, 2}})
    ->Unit(benchmark::kMillisecond);

int main(int argc, char** argv)
{
  const tribound::algebra::Environment petsc;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
