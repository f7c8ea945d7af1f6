#pragma once
// Pictures that were shown against converged ones of the same moments.

#include "viewer/app/shown_views.h"
#include "viewer/app/user_avatars.h"
#include "viewer/bench/shown/shown_bench.h"

namespace viewer {

/// What was seen at a moment.
struct SeenMoment {
    Viewpoint at;
    double path_s = 0, scene_s = 0;
    std::vector<std::vector<unsigned char>> shown; ///< per eye: R, G, B bytes, rows from the top
    std::vector<LightSources> light;               ///< per eye; empty where no surfaces were drawn
};

/// Something that changes while the head is on its path.
struct PathChange {
    double path_s = 0;
    Change change;
};
/// In the order of their times. Throws InputError.
/// @param file  with further ones, one a line, comments begin with #; empty = none
std::vector<PathChange> path_changes(std::vector<std::string> const& texts, std::string const& file);

/// Means over eyes and moments.
struct ShownErrors {
    double flip = 0, most_flip = 0; ///< most: of a moment and an eye
    double rivalry = 0; ///< mean difference of the eyes' errors (display-encoded, 0..255) at points that both see
    /// Share of the pixels of surfaces that no picture of light shows; mean difference there over the mean truth there.
    /// NaN: there are none.
    double unlit_share = 0, unlit_error = 0;
    int moments = 0; ///< that were scored before a stop
};

/// Renders the truth by the method reference, and writes pictures and their FLIP maps.
/// @param origin  of the world
ShownErrors score(ShownOptions const& options, std::span<PathChange const> changes, RecordedScenes const& scenes,
                  std::vector<SeenMoment> const& seen, gi::dvec3 origin, gi::StopRequest const& stop);

} // namespace viewer
