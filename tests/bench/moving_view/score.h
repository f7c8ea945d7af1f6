#pragma once
// Pictures that were shown against converged ones of the same moments.

#include "tests/bench/moving_view/walk.h"
#include "viewer/app/user_avatars.h"

namespace viewer {

/// What was seen at a scored moment.
struct Seen {
    Viewpoint at;
    double scene_s = 0;
    std::vector<std::vector<unsigned char>> shown; ///< per eye
};

/// Renders the truth, writes pictures and their errors, and prints FLIP.
/// @param origin  of the world
void score(Options const& o, RecordedScenes const& scenes, std::vector<Seen> const& seen, gi::dvec3 origin);

} // namespace viewer
