#pragma once

/// @file tribound.h
/// All of Tribound that programs use, in the order of the method. What is not here, nor included from here,
/// are the parts of these parts.

// The problem: what the case file says, and what holds where.
#include "tribound/base/apart.h"
#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/base/version.h"
#include "tribound/case/config.h"
#include "tribound/case/resolve.h"
#include "tribound/case/sweep_values.h"
#include "tribound/problem/field.h"
#include "tribound/problem/formula.h"
#include "tribound/problem/normal_field.h"
#include "tribound/problem/problem.h"
#include "tribound/problem/surface.h"
#include "tribound/problem/water.h"

// The mesh.
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/cut_open.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/mesh/mesh.h"
#include "tribound/mesh/overlay.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/quadratic_surface.h"
#include "tribound/mesh/refine.h"
#include "tribound/mesh/share_out.h"
#include "tribound/mesh/shared_facets.h"
#include "tribound/mesh/triangulated_surface.h"

// The discrete problem: P^p Lagrange elements and the Nitsche form.
#include "tribound/contact/nitsche/contact_history.h"
#include "tribound/contact/nitsche/contact_moments.h"
#include "tribound/contact/nitsche/crack_mouth.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/interface_check.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/contact/nitsche/segment_values.h"
#include "tribound/contact/pairing/pairing.h"
#include "tribound/contact/pairing/polygon.h"
#include "tribound/contact/support/rigid_motion.h"
#include "tribound/fem/bernstein.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/lagrange.h"
#include "tribound/fem/nested.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/space.h"
#include "tribound/problem/projection.h"

// Its solution by the generalised Newton method.
#include "tribound/algebra/cholesky.h"
#include "tribound/algebra/condensation.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/algebra/petsc.h"
#include "tribound/solve/newton.h"

// The equilibrated stress, its identities, the components of the bound, and what may be claimed.
#include "tribound/certify/bound/certificate.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/components.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/data_terms.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/equilibrate/stress.h"

// What deserves a look before and after.
#include "tribound/doctor/diagnosis.h"
#include "tribound/doctor/solution_facts.h"

// What the bound is compared with.
#include "tribound/certify/truth/solution_error.h"
#include "tribound/certify/truth/true_error.h"

// The adaptive loop: a level of it, where to refine, the whole.
#include "tribound/adapt/contact_functions.h"
#include "tribound/adapt/excerpt.h"
#include "tribound/adapt/history_check.h"
#include "tribound/adapt/level.h"
#include "tribound/adapt/levels.h"
#include "tribound/adapt/load_path.h"
#include "tribound/adapt/loop.h"
#include "tribound/adapt/mark.h"
#include "tribound/adapt/path_program.h"
#include "tribound/adapt/persistent.h"
#include "tribound/adapt/rate.h"
#include "tribound/adapt/regularisation.h"
#include "tribound/adapt/replay.h"
#include "tribound/adapt/saved_path.h"
#include "tribound/adapt/transfer.h"

// The results.
#include "tribound/io/fields/contact_line.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/history_check.h"
#include "tribound/io/record/level_record.h"
#include "tribound/io/record/load_step_record.h"
#include "tribound/io/record/report.h"
#include "tribound/io/record/solution_figures.h"
#include "tribound/io/record/tables.h"
#include "tribound/io/state/checkpoint.h"
#include "tribound/io/state/path_checkpoint.h"
