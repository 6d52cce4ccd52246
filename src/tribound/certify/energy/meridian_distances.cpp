#include "tribound/certify/energy/meridian_distances.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tribound/base/norm.h"
#include "tribound/base/parallel.h"
#include "tribound/certify/energy/meridian_admissible.h"
#include "tribound/certify/equilibrate/meridian_fields.h"

namespace tribound::certify
{

namespace
{

std::vector<std::array<double, 3>> radii_of_cells(const contact::NitscheForm<2>& form)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  std::vector<std::array<double, 3>> result(mesh.n_owned_cells());
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const mesh::Cell<2> vertices = sorted_vertices<2>(mesh.cell(c));
    for (int i = 0; i < 3; ++i) result[c][i] = mesh.vertex(vertices[i])[0];
  }
  return result;
}

/// What is known of the cells of a form.
class MeridianCellStresses
{
 public:
  explicit MeridianCellStresses(const contact::NitscheForm<2>& form)
      : form_(form), fields_(form), solver_(radii_of_cells(form), form.space().degree() + 1)
  {
  }

  /// One cell.
  struct Cell
  {
    Index number;
    SortedCell<2> sorted;
    MeridianMetric metric;
  };
  [[nodiscard]] Cell cell(Index c) const
  {
    const mesh::Mesh<2>& mesh = form_.space().mesh();
    return {c, make_sorted_cell(mesh, c), solver_.metric(c, form_.problem().material(mesh.region(c)))};
  }

  /// r C eps(w), on the cell.
  [[nodiscard]] MeridianStress elastic(const Cell& cell, std::span<const double> w) const
  {
    const MeridianFields::WeightedStress stress = fields_.stress(cell.number, cell.sorted, w);
    MeridianStress result(stress.hoop.size(), 4);
    result << stress.plane[0][0], stress.plane[1][1], (stress.plane[0][1] + stress.plane[1][0]) * M_SQRT1_2,
        stress.hoop;
    return result;
  }
  /// r (C eps(w) + Pi^p sigma_0), on the cell.
  [[nodiscard]] MeridianStress total(const Cell& cell, std::span<const double> w) const
  {
    const MeridianReference& reference = fields_.reference();
    MeridianStress result = MeridianStress::Zero(reference.n_stress, 4);
    result.topRows(reference.n_divergence) = elastic(cell, w);
    if (!fields_.has_initial_stress(cell.number)) return result;
    const Eigen::MatrixXd times_r = fields_.times_radius(fields_.radii(cell.sorted));
    const std::array<Eigen::VectorXd, 4> initial = fields_.initial_stress(cell.number, cell.sorted);
    constexpr std::array<double, 4> sizes = {1, 1, M_SQRT2, 1};
    for (int i = 0; i < 4; ++i)
      result.col(i) += sizes[i] * (times_r * initial[i].head(reference.n_divergence));
    return result;
  }
  [[nodiscard]] MeridianStress on_pieces(const MeridianStress& on_cell) const
  {
    return solver_.on_pieces(on_cell);
  }

  /// The admissible stress with the tractions and the divergence of tau_h and vartheta_h = div tau_{h,r} + r
  /// f~_r that is nearest to the target, which is one on the cell; r f~_r is given by `loads`.
  [[nodiscard]] AdmissibleMeridianStress nearest(const Cell& cell, std::span<const double> tau_h,
                                                 const MeridianFields& loads,
                                                 const MeridianStress& target) const
  {
    const MeridianReference& reference = fields_.reference();
    const int n = reference.n_stress;
    Eigen::VectorXd vartheta_h = loads.load(cell.number, cell.sorted)[0];
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l)
        vartheta_h += cell.sorted.inverse(l, k) *
                      (reference.derivative[l] * Eigen::Map<const Eigen::VectorXd>(&tau_h[k * n], n));
    const Eigen::VectorXd r_vartheta_h = fields_.times_radius(fields_.radii(cell.sorted)) * vartheta_h;
    AdmissibleMeridianStress result =
        solver_.solve(cell.number, cell.sorted, cell.metric, tau_h, r_vartheta_h, target);
    if (const double size = norm(tau_h); size > 0) result.unbalanced /= size;
    return result;
  }
  [[nodiscard]] const MeridianFields& loads() const { return fields_; }

  /// visit(cell) for all own cells, distributed to threads; what it returns is the part that a cell does not
  /// balance. The largest of these.
  template <class Visit>
  double visit_cells(const Visit& visit) const
  {
    std::vector<double> unbalanced(form_.space().mesh().n_owned_cells(), 0.0);
    parallel_for(
        unbalanced.size(), [&](std::size_t k) { unbalanced[k] = visit(cell(static_cast<Index>(k))); }, 4);
    double result = 0;
    for (const double x : unbalanced) result = std::max(result, x);
    return result;
  }

 private:
  const contact::NitscheForm<2>& form_;
  MeridianFields fields_;
  MeridianStressSolver solver_;
};

}  // namespace

CellDistances meridian_distances(const contact::NitscheForm<2>& form, const Stress<2>& stress,
                                 std::span<const double> u, std::span<const double> v)
{
  const MeridianCellStresses cells(form);
  const std::vector<double> none(form.space().mesh().n_owned_cells(), 0.0);
  CellDistances result{none, none, none};
  std::vector<double> c(u.begin(), u.end());
  for (std::size_t i = 0; i < c.size(); ++i) c[i] -= v[i];
  result.unbalanced = cells.visit_cells(
      [&](const MeridianCellStresses::Cell& cell)
      {
        const AdmissibleMeridianStress tau =
            cells.nearest(cell, stress.dis_in(cell.number), cells.loads(), cells.total(cell, v));
        const MeridianStress of_c = cells.on_pieces(cells.elastic(cell, c));
        result.square[cell.number] = cell.metric.square(tau.difference);
        result.correction[cell.number] = cell.metric.square(of_c);
        // (tau + sigma(v))/2 - sigma(u) = (tau - sigma(v))/2 - C eps(c)
        result.to_discrete[cell.number] = cell.metric.square(0.5 * tau.difference - of_c);
        return tau.unbalanced;
      });
  return result;
}

DualProducts meridian_products(const contact::NitscheForm<2>& form, const Stress<2>& stress,
                               std::span<const double> v, const DualPair<2>& pair)
{
  const MeridianCellStresses cells(form);
  std::optional<MeridianFields> dual_loads;
  if (pair.stress) dual_loads.emplace(*pair.form);
  const std::vector<double> none(form.space().mesh().n_owned_cells(), 0.0);
  DualProducts result{none, none, none, none, none};
  result.unbalanced = cells.visit_cells(
      [&](const MeridianCellStresses::Cell& cell)
      {
        const Index k = cell.number;
        const MeridianMetric& metric = cell.metric;
        const MeridianStress of_v = cells.total(cell, v);
        const MeridianStress error = cells.nearest(cell, stress.dis_in(k), cells.loads(), of_v).difference;
        const MeridianStress tau = cells.on_pieces(of_v) + error;
        const MeridianStress of_z = cells.on_pieces(cells.elastic(cell, pair.z));
        MeridianStress zeta = MeridianStress::Zero(of_z.rows(), 4);
        double unbalanced = 0;
        if (pair.stress)
        {
          const MeridianStress target = cells.elastic(cell, pair.target);  // without initial stress
          const auto nearest = cells.nearest(cell, pair.stress->dis_in(k), *dual_loads, target);
          zeta = cells.on_pieces(target) + nearest.difference;
          unbalanced = nearest.unbalanced;
        }
        const MeridianStress mean = 0.5 * (zeta + of_z);
        result.centre[k] = metric.product(mean, error);
        result.square[k] = metric.square(zeta - of_z);
        result.work[k] = metric.product(tau, of_z);
        result.energy[k] = metric.square(of_z);
        // squares are larger than those by the rule by as much as these may be too small
        result.doubt[k] = 4 * metric.doubt(mean, error) + 2 * metric.doubt(zeta - of_z, zeta - of_z) +
                          2 * metric.doubt(tau, of_z) + 2 * metric.doubt(error, error);
        return unbalanced;
      });
  return result;
}

}  // namespace tribound::certify
