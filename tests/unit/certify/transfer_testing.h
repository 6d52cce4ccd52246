#pragma once

/// @file transfer_testing.h
/// Random cells, and tractions on parts of one of their facets.

#include <algorithm>
#include <random>
#include <vector>

#include "tribound/certify/bound/transfer.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/mesh.h"

namespace tribound::test
{

using certify::TractionPiece;

inline constexpr int facet_number = 0;  ///< in the cell

/// The reference cell with its vertices moved.
template <int dim>
mesh::Mesh<dim> random_cell(std::mt19937& random)
{
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  mesh::MeshData<dim> data;
  auto x = fem::reference_simplex<dim>();
  for (Point<dim>& vertex : x) vertex += Point<dim>::NullaryExpr([&] { return shift(random); });
  data.vertices.assign(x.begin(), x.end());
  data.cells.emplace_back();
  for (int i = 0; i <= dim; ++i) data.cells[0][i] = i;
  data.regions = {0};
  data.region_names = {"cell"};
  return mesh::Mesh<dim>(std::move(data));
}

template <int dim>
mesh::BoundaryFacet first_facet(const mesh::Mesh<dim>& mesh)
{
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.local == facet_number) return facet;
  return {};
}

template <int dim>
TractionPiece<dim> random_traction(const fem::Part<dim - 1>& part, int degree, std::mt19937& random)
{
  std::uniform_real_distribution<double> value(-1, 1);
  TractionPiece<dim> piece{part, {}};
  for (int i = 0; i < fem::polynomial_dimension(dim - 1, degree); ++i)
    piece.coefficients.push_back(Point<dim>::NullaryExpr([&] { return value(random); }));
  return piece;
}

/// Parts of the facet with random tractions, cut at random and numbered either way; `left_out` of them are
/// not covered.
template <int dim>
std::vector<TractionPiece<dim>> random_pieces(int degree, int n_cuts, int left_out, std::mt19937& random)
{
  std::vector<fem::Part<dim - 1>> parts = {fem::reference_simplex<dim - 1>()};
  std::uniform_real_distribution<double> share(0.2, 0.8);
  for (int n = 0; n < n_cuts; ++n)
  {
    const std::size_t k = random() % parts.size();
    const int i = static_cast<int>(random() % dim);
    const int j = (i + 1) % dim;
    const double t = share(random);
    const auto halves =
        fem::split<dim - 1>(parts[k], i, j, Point<dim - 1>((1 - t) * parts[k][i] + t * parts[k][j]));
    parts[k] = halves[0];
    parts.push_back(halves[1]);
  }
  std::ranges::shuffle(parts, random);
  parts.resize(parts.size() - left_out);
  std::vector<TractionPiece<dim>> pieces;
  for (fem::Part<dim - 1>& part : parts)
  {
    std::ranges::shuffle(part, random);
    pieces.push_back(random_traction<dim>(part, degree, random));
  }
  return pieces;
}

}  // namespace tribound::test
