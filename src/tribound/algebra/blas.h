#pragma once

/// @file blas.h
/// The BLAS library of the process.

#include <string>

namespace tribound::algebra
{

/// On processors newer than itself OpenBLAS falls back to the kernels of the oldest processor it knows, a
/// third as fast in factorisations. In that case this selects the kernels for the vector instructions that
/// the processor has. Nothing changes with another library, a processor that OpenBLAS knows, or a choice by
/// the environment variable OPENBLAS_CORETYPE. To be called before any other function of the library, on one
/// thread.
void choose_blas_kernels();

struct BlasFacts
{
  std::string library;  ///< its file, symbolic links resolved, and OpenBLAS's kernels
  int threads = 0;      ///< 0: unknown
};
[[nodiscard]] BlasFacts blas_facts();

/// Sets the number of threads, if the library is OpenBLAS.
void set_blas_threads(int n);

}  // namespace tribound::algebra
