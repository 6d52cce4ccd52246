#include "tribound/mesh/first_facet_finder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tribound::mesh
{

namespace
{

template <int dim>
std::array<Point<dim>, dim> first_corners(const FirstFacets& facets, std::size_t facet)
{
  std::array<Point<dim>, dim> points;
  for (int i = 0; i < dim; ++i) points[i] = facets.point<dim>(facets.vertices_of<dim>(facet)[i]);
  return points;
}

/// Barycentric coordinates of x in a facet, up to rounding in its plane.
template <int dim>
std::array<double, dim> barycentric_in(const FacetMap<dim>& map, const Point<dim>& x)
{
  const Eigen::Matrix<double, dim - 1, dim - 1> gram = map.jacobian.transpose() * map.jacobian;
  const Point<dim - 1> moments = map.jacobian.transpose() * (x - map.origin);
  std::array<double, dim> result{1};
  if constexpr (dim == 2)
    result[1] = moments[0] / gram(0, 0);
  else
  {
    const double det = gram(0, 0) * gram(1, 1) - gram(0, 1) * gram(1, 0);
    result[1] = (moments[0] * gram(1, 1) - moments[1] * gram(0, 1)) / det;
    result[2] = (moments[1] * gram(0, 0) - moments[0] * gram(1, 0)) / det;
  }
  result[0] -= std::accumulate(result.begin() + 1, result.end(), 0.0);
  constexpr double rounding = 1e-9;
  for (double& lambda : result)
    if (std::abs(lambda) <= rounding) lambda = 0;
  const double sum = std::accumulate(result.begin(), result.end(), 0.0);
  for (double& lambda : result) lambda /= sum;  // 1 where the others are 0
  return result;
}

}  // namespace

template <int dim>
FirstFacetFinder<dim>::FirstFacetFinder(const FirstFacets& facets, const std::function<bool(int)>& is_meant)
    : facets_(facets)
{
  std::vector<BoundingBox<dim>> boxes;
  for (std::size_t f = 0; f < facets.tags.size(); ++f)
  {
    if (!is_meant(facets.tags[f])) continue;
    meant_.push_back(f);
    boxes.push_back(bounding_box<dim>(first_corners<dim>(facets, f)));
  }
  tree_ = BoxTree<dim>(boxes);
}

template <int dim>
auto FirstFacetFinder<dim>::operator()(int tag, const std::array<Point<dim>, dim>& vertices) const -> Place
{
  Point<dim> centre = Point<dim>::Zero();
  for (const Point<dim>& x : vertices) centre += x / dim;
  constexpr double close = 1e-3;  // of the diameter: rounding is far less
  const double near = close * diameter(vertices);
  Place best{};
  double least = HUGE_VAL;  // how far the vertices are outside, relative to the size of the facet
  tree_.traverse([&](const BoundingBox<dim>& box) { return square_distance(box, centre) <= near * near; },
                 [&](std::size_t k)
                 {
                   if (facets_.tags[meant_[k]] != tag) return;
                   const std::array<Point<dim>, dim> points = first_corners<dim>(facets_, meant_[k]);
                   const FacetMap<dim> map = facet_map<dim>(points);
                   Place place{meant_[k], {}};
                   double outside = 0;
                   for (int j = 0; j < dim; ++j)
                   {
                     std::array<double, dim>& lambda = place.barycentric[j];
                     lambda = barycentric_in<dim>(map, vertices[j]);
                     Point<dim> foot = Point<dim>::Zero();
                     for (int i = 0; i < dim; ++i) foot += lambda[i] * points[i];
                     outside = std::max({outside, -*std::ranges::min_element(lambda),
                                         (vertices[j] - foot).norm() / diameter(points)});
                   }
                   if (outside < least) best = place;
                   least = std::min(least, outside);
                 });
  constexpr double rounding = 1e-6;
  assert(least <= rounding);
  (void)rounding;
  return best;
}

template class FirstFacetFinder<2>;
template class FirstFacetFinder<3>;

}  // namespace tribound::mesh
