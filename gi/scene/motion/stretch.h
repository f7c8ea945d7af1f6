#pragma once
// Polar decomposition: a linear map as a stretch followed by a rotation.

#include "gi/core/math.h"

namespace gi {

/// Returns the rotation Q, det Q = 1, that is nearest to m, or to -m if m mirrors; so Q^-1 m stretches along three
/// perpendicular directions (by negative factors if m mirrors). Also works for m of rank 2; returns the identity
/// for lower rank or non-finite m. Newton's iteration for the polar factor (Higham 1986, "Computing the Polar
/// Decomposition", eq. 2.1), started at m plus its cofactors, which has the same singular directions and is
/// regular for m of rank 2.
glm::dmat3 nearest_rotation(glm::dmat3 const& m);

} // namespace gi
