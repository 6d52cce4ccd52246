#pragma once

/// @file run_adaptively.h
/// The adaptive algorithm from the data of a problem.

#include <atomic>
#include <memory>
#include <utility>

#include "support/problem_data.h"
#include "tribound/adapt/loop.h"

namespace tribound::test
{

template <int dim>
certify::Verdict run_adaptively(mesh::MeshData<dim> mesh_data, const ProblemData<dim>& data,
                                const adapt::Method& method, const adapt::AdaptOptions& options,
                                const adapt::LoopObserver<dim>& observer,
                                const std::atomic<bool>& stop = false)
{
  mesh::Mesh<dim> mesh(std::move(mesh_data));
  const problem::Problem<dim> problem = data.on(mesh);
  auto first = std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, method);
  return adapt::adapt<dim>(problem, method, options, std::move(first), observer, stop);
}

}  // namespace tribound::test
