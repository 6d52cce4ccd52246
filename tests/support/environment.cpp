/// @file environment.cpp
/// Starts MPI and PETSc once for a test program.

#include <gtest/gtest.h>

#include <memory>

#include "tribound/algebra/petsc.h"

namespace
{

class PetscEnvironment : public ::testing::Environment
{
 public:
  void SetUp() override { environment_ = std::make_unique<tribound::algebra::Environment>(); }
  void TearDown() override { environment_.reset(); }

 private:
  std::unique_ptr<tribound::algebra::Environment> environment_;
};

// GoogleTest owns it.
[[maybe_unused]] auto* const registered = ::testing::AddGlobalTestEnvironment(new PetscEnvironment);

}  // namespace
