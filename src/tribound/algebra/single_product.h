#pragma once

/// @file single_product.h
/// Products in single precision, for preconditioners: a matrix in blocks of floats is a third of its size in
/// double precision with an index per entry, and products take as long as reading it.

#include "tribound/algebra/petsc_detail.h"

namespace tribound::algebra::detail
{

/// From now on MatMult() with this matrix is in single precision: to some 1e-7 of |A| |x|, whatever their
/// units; on several ranks the columns of own unknowns are. To be called again when the matrix has changed.
void multiply_in_single(Mat a);

/// The same for MatMultAdd(), which multigrid calls with interpolations.
void interpolate_in_single(Mat p);

/// The same for one that is needed exactly as well, while this is alive.
class SingleProduct
{
 public:
  explicit SingleProduct(Mat a);
  ~SingleProduct();
  SingleProduct(const SingleProduct&) = delete;
  SingleProduct& operator=(const SingleProduct&) = delete;

  /// A matrix whose product is that of `a` before. Not to be used for anything else, nor later.
  [[nodiscard]] Mat exact() const { return exact_.get(); }

 private:
  Mat own_;
  void (*product_)() = nullptr;  ///< that of own_
  MatHandle exact_;
};

}  // namespace tribound::algebra::detail
