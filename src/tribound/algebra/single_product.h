#pragma once

/// @file single_product.h
/// Products in single precision, for preconditioners. In blocks of floats a matrix has a third of its size in
/// double precision with an index per entry, and a product takes as long as reading it. Products in double
/// precision where these are needed, too.

#include "tribound/algebra/petsc_detail.h"

namespace tribound::algebra::detail
{

/// From now on MatMult() with this matrix is in single precision, accurate to some 1e-7 of |A| |x| in any
/// units; on several ranks only the columns of own unknowns are. Call it again when the matrix has changed.
void multiply_in_single(Mat a);

/// The same for MatMultAdd(), which multigrid calls with interpolations.
void interpolate_in_single(Mat p);

/// The same, while this is alive, for a matrix that is needed exactly as well.
class SingleProduct
{
 public:
  explicit SingleProduct(Mat a);
  ~SingleProduct();
  SingleProduct(const SingleProduct&) = delete;
  SingleProduct& operator=(const SingleProduct&) = delete;

  /// A matrix with the product of `a` in double precision. For products only, and only while this is alive.
  [[nodiscard]] Mat exact() const { return exact_.get(); }

 private:
  Mat own_;
  void (*product_)() = nullptr;  ///< that of own_
  MatHandle exact_;
};

}  // namespace tribound::algebra::detail
