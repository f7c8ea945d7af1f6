#pragma once
// Nested windows of hit buffers and shadow maps: grids of their own for what is near the cameras, so that texels suit a
// room in a large world (as clipmaps do, Tanner, Migdal and Jones 1998). A window is bounded across its axis only: its
// columns hold all layers of the world, so that a look-up takes the finest grid over its origin and needs no other.

#include "gi/hit_buffers/settings.h"
#include "gi/raster/triangle_soup.h"
#include "gi/scene/model/camera.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace gi {

/// Levels of grids, that of the whole world included.
inline constexpr std::size_t kMostLevels = 6;

struct Surroundings {
    Bounds
        box; ///< of the nearest four fifths of what is seen in all directions, and of the eye; empty if nothing is
    float middle_m = 0; ///< the median distance
};
Surroundings surroundings(TriangleSoup const& soup, vec3 eye, float near_m);

/// Boxes of windows, each within the one before, the last around `near`; none where the whole world is less than six times
/// as wide. @param resolution  texels per side  @param levels  at most, that of the whole world included; 0 = kMostLevels
std::vector<Bounds> nested_windows(Bounds const& whole, Bounds const& near, std::uint32_t resolution,
                                   std::size_t levels);

/// Windows for what cameras see and paths meet around them; none for orthographic cameras.
class Windows {
public:
    /// @param settings  chosen ones
    explicit Windows(SlhbSettings const& settings)
        : resolution_(std::uint32_t(std::max(settings.resolution, settings.shadow_resolution))),
          levels_(std::size_t(settings.levels))
    {
    }

    /// Follows cameras that have left what was near them, and a world that grows. Returns true if the windows are others
    /// now: what has them must be built anew.
    bool follow(Bounds const& whole, TriangleSoup const& soup, std::span<CameraRays const> cameras);
    std::vector<Bounds> const& boxes() const { return boxes_; }
    /// What says so among a method's options; empty without windows, and where --levels was given.
    std::string option() const
    {
        return boxes_.empty() || levels_ > 0 ? "" : " --levels " + std::to_string(boxes_.size() + 1);
    }

private:
    std::uint32_t resolution_;
    std::size_t levels_;
    struct Look {
        vec3 eye;
        float reach_m; ///< around the eye within which its surroundings are about the same
    };

    Bounds whole_;
    Bounds near_;             ///< in which the cameras may move
    float size_ = 0;          ///< m, of their surroundings
    std::vector<Look> looks_; ///< at the surroundings
    bool placed_ = false;
    std::vector<Bounds> boxes_;
};

} // namespace gi
