#pragma once
// Sets of directions that sample the sphere (Yu 2012, sec. 3.3). Opposite directions see the same surfaces in
// opposite order, so both form one *axis*. Every set is point-symmetric.

#include "gi/core/math.h"

#include <string>
#include <vector>

namespace gi {

struct DirectionSet {
    std::string name;        ///< as requested, e.g. "icosahedron:320"
    std::vector<dvec3> axes; ///< unit vectors
    /// Directions: 2 k is axes[k], 2 k + 1 its opposite.
    std::size_t size() const { return 2 * axes.size(); }
    dvec3 direction(std::size_t i) const { return i % 2 == 0 ? axes[i / 2] : -axes[i / 2]; }
};

/// "FAMILY:COUNT", COUNT directions in all (opposites included):
///   icosahedron, octahedron   centres of the faces after L subdivisions, 20 * 4^L and 8 * 4^L
///   tetrahedron               those of the tetrahedron and their opposites, 8 * 4^L
///   uv_grid                   centres of the thesis's spherical triangles (fig. 3.4), 8 * L^2
///   halton, fibonacci         any even count: Halton points (bases 2, 3) or a spherical Fibonacci lattice on the
///                             hemisphere z > 0, and their opposites
/// Throws InputError on other names and counts; the message names the nearest valid count.
DirectionSet make_directions(std::string const& name);

} // namespace gi
