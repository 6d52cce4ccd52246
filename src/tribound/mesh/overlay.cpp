#include "tribound/mesh/overlay.h"

#include <cmath>
#include <stdexcept>

#include "tribound/mesh/geometry.h"

namespace tribound::mesh
{

namespace
{

/// A position in the list of the cells of a mesh.
template <int dim>
class Cursor
{
 public:
  explicit Cursor(const Mesh<dim>& mesh) : mesh_(&mesh) {}

  [[nodiscard]] bool at_end() const { return cell_ == mesh_->n_cells(); }
  [[nodiscard]] Index cell() const { return cell_; }
  [[nodiscard]] double measure() const { return determinant<dim>(points()); }
  [[nodiscard]] std::array<Point<dim>, dim + 1> points() const
  {
    return points_of(mesh_->vertices(), mesh_->cell(cell_));
  }

  /// Takes this part of the cell, a power of 2, and goes on to the next cell when nothing is left. Sums of
  /// such parts are exact, as long as a cell is not bisected more than 52 times.
  void take(double part)
  {
    taken_ += part;
    if (taken_ < 1) return;
    taken_ = 0;
    ++cell_;
  }

 private:
  const Mesh<dim>* mesh_;
  Index cell_ = 0;
  double taken_ = 0;  ///< of the cell
};

/// Whether the middle of a simplex lies in another one.
template <int dim>
bool contains(const std::array<Point<dim>, dim + 1>& large, const std::array<Point<dim>, dim + 1>& small)
{
  Point<dim> middle = Point<dim>::Zero();
  for (const Point<dim>& x : small) middle += x / (dim + 1.0);
  const double whole = determinant<dim>(large);
  for (int i = 0; i <= dim; ++i)
  {
    auto part = large;
    part[i] = middle;
    if (determinant<dim>(part) <= 0 || determinant<dim>(part) > whole) return false;
  }
  return true;
}

}  // namespace

template <int dim>
std::vector<CellPair> overlay(const Mesh<dim>& a, const Mesh<dim>& b)
{
  std::vector<CellPair> pairs;
  pairs.reserve(std::max(a.n_cells(), b.n_cells()));
  Cursor<dim> at(a);
  Cursor<dim> bt(b);
  while (!at.at_end() && !bt.at_end())
  {
    const double bisections = std::round(std::log2(at.measure() / bt.measure()));
    const bool a_is_larger = bisections >= 0;
    if (!(a_is_larger ? contains<dim>(at.points(), bt.points()) : contains<dim>(bt.points(), at.points())))
      throw std::invalid_argument("overlay: the meshes do not come from one mesh by bisection");
    pairs.push_back({at.cell(), bt.cell()});
    at.take(a_is_larger ? std::exp2(-bisections) : 1);
    bt.take(a_is_larger ? 1 : std::exp2(bisections));
  }
  if (!at.at_end() || !bt.at_end())
    throw std::invalid_argument("overlay: the meshes do not cover the same domain");
  return pairs;
}

template std::vector<CellPair> overlay(const Mesh<2>&, const Mesh<2>&);
template std::vector<CellPair> overlay(const Mesh<3>&, const Mesh<3>&);

}  // namespace tribound::mesh
