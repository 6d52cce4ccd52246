#pragma once

/// @file tribound.h
/// All of Tribound that programs use, in the order of the method. What is not here, nor included from here,
/// are the parts of these parts.

// The problem: what the case file says, and what holds where.
#include "base/apart.h"
#include "base/error.h"
#include "base/types.h"
#include "base/version.h"
#include "case/config.h"
#include "case/expression.h"
#include "case/formula.h"
#include "case/problem.h"
#include "case/sweep_values.h"

// The mesh.
#include "mesh/bisect.h"
#include "mesh/box.h"
#include "mesh/describe.h"
#include "mesh/geometry.h"
#include "mesh/gmsh.h"
#include "mesh/mesh.h"
#include "mesh/overlay.h"
#include "mesh/refine.h"

// The discrete problem: P^p Lagrange elements and the Nitsche form.
#include "contact/elasticity.h"
#include "contact/nitsche.h"
#include "contact/projection.h"
#include "contact/rigid_motion.h"
#include "contact/traction.h"
#include "fem/bernstein.h"
#include "fem/lagrange.h"
#include "fem/nested.h"
#include "fem/polynomials.h"
#include "fem/quadrature.h"
#include "fem/space.h"

// Its solution by the generalised Newton method.
#include "solve/cholesky.h"
#include "solve/linear_solver.h"
#include "solve/newton.h"
#include "solve/petsc.h"

// The equilibrated stress, its identities, the components of the bound, and what may be claimed.
#include "certify/certificate.h"
#include "certify/checks.h"
#include "certify/contact_terms.h"
#include "certify/data_terms.h"
#include "certify/equilibrate.h"
#include "certify/estimate.h"
#include "certify/friedrichs.h"
#include "certify/stress.h"

// What deserves a look before and after.
#include "doctor/diagnosis.h"
#include "doctor/solution_facts.h"

// What the bound is compared with.
#include "certify/solution_error.h"
#include "certify/true_error.h"

// The adaptive loop: a level of it, where to refine, the whole.
#include "adapt/level.h"
#include "adapt/loop.h"
#include "adapt/mark.h"
#include "adapt/persistent.h"
#include "adapt/rate.h"
#include "adapt/regularisation.h"

// The results.
#include "io/contact_line.h"
#include "io/facts.h"
#include "io/report.h"
#include "io/verification.h"
#include "io/vtu.h"
