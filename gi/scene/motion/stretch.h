#pragma once
// A linear map as a rotation after a stretch (polar decomposition).

#include "gi/core/math.h"

namespace gi {

/// The rotation Q, det Q = 1, that is nearest to m, or to -m where m mirrors; so Q^-1 m stretches along three
/// perpendicular directions (by negative factors where m mirrors). Also for a flattened m; the identity for what
/// leaves no more than a line, or is not finite. Newton's iteration for the polar factor (Higham 1986, "Computing
/// the Polar Decomposition", eq. 2.1), started at m plus its cofactors: same directions, and regular where m is
/// flat.
glm::dmat3 nearest_rotation(glm::dmat3 const& m);

} // namespace gi
