#pragma once

/// @file tribound.h
/// All of Tribound, in the order of the method.

// The problem: what the case file says, and what holds where.
#include "base/error.h"
#include "base/version.h"
#include "case/config.h"
#include "case/problem.h"

// The mesh.
#include "mesh/bisect.h"
#include "mesh/box.h"
#include "mesh/geometry.h"
#include "mesh/gmsh.h"
#include "mesh/mesh.h"
#include "mesh/refine.h"

// The discrete problem: P^p Lagrange elements and the Nitsche form.
#include "contact/elasticity.h"
#include "contact/nitsche.h"
#include "contact/projection.h"
#include "contact/rigid_motion.h"
#include "fem/nested.h"
#include "fem/space.h"

// Its solution by the generalised Newton method.
#include "solve/newton.h"
#include "solve/petsc.h"

// The equilibrated stress, its identities, the components of the bound, and what may be claimed.
#include "certify/certificate.h"
#include "certify/checks.h"
#include "certify/equilibrate.h"
#include "certify/estimate.h"

// Where to refine.
#include "adapt/mark.h"

// What the bound is compared with.
#include "certify/true_error.h"
