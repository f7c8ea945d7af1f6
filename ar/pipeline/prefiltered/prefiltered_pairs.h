#pragma once
// Pairs for compositing by prefiltered light: one point a pixel, no paths, no noise.

#include "ar/pipeline/first_surfaces.h"
#include "ar/pipeline/pair_pictures.h"
#include "ar/pipeline/prefiltered/prefiltered_light.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/scene/motion/moving_world.h"

#include <string>

namespace ar {

/// Why a world cannot be lit by prefiltered light; empty: it can. It knows matt and broadly
/// glossy surfaces under an environment map.
std::string needs_paths(gi::World const& world);

class PrefilteredPairs {
public:
    /// @param world  with the virtual objects in place, also during calls; it and the report must outlive this
    /// @throws gi::Interrupted
    PrefilteredPairs(gi::World const& world, gi::Report& report, gi::StopRequest const& stop);

    /// Call before each further picture. @param changes  of the world since the last one
    /// @throws gi::Interrupted
    void update(gi::Changes const& changes, gi::StopRequest const& stop);
    /// @param stop  on request, rows are left out
    PairPictures render(gi::Camera const& camera, int width, int height, gi::StopRequest const& stop);

private:
    void report_counts();

    gi::World const& world_;
    gi::Report& report_;
    PrefilteredLight light_;
    SurfaceView all_, still_;
    SurfaceRaster all_raster_, still_raster_; ///< reused
};

} // namespace ar
