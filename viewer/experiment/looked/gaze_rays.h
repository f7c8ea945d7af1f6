#pragma once
// Which surface a gaze meets in a world, by way of mirrors and panes.

#include "gi/render/exact_visibility.h"

namespace viewer {

/// Mirrors and panes that a gaze follows, one behind the other.
inline constexpr int kMostGazeMirrors = 8;

struct GazeMeeting {
    std::uint32_t triangle = gi::kNoTriangle; ///< none: the background
    int mirrors = 0;                          ///< mirrors and panes on the way
    bool is_cut = false;                      ///< there are more of them; `triangle` is the last one
};

class GazeRays {
public:
    /// @param world  must outlive this   @param threads  0 = all
    GazeRays(gi::World const& world, int threads) : view_(gi::view(world)), visibility_(world, true, threads) {}
    /// What each ray meets: the first surface that is neither mirror nor pane (gi/scene/shading/seen_mirror.h). Rays are
    /// reflected and refracted as the shading normals say, so that they show what the picture shows there.
    std::vector<GazeMeeting> meet(std::vector<gi::Ray> rays) const;

private:
    gi::WorldView view_;
    gi::ExactVisibility visibility_;
};

} // namespace viewer
