#pragma once
// What the renderers of both memory spaces keep of the world and of the views between passes and frames, and how both
// follow changes.

#include "gi/hit_buffers/directions/grid_bounds.h"
#include "gi/hit_buffers/settings.h"
#include "gi/hit_buffers/windows.h"
#include "gi/methods/paths/motion.h"
#include "gi/raster/cut_outs.h"
#include "gi/render/frame_renderer.h"

namespace gi {

struct TracedWorld {
    TracedWorld(World const& world, TriangleSoup triangles, std::size_t first, SlhbSettings const& settings)
        : first_moving(first),
          soup(std::move(triangles)),
          cut_outs(world),
          grid_bounds(gi::grid_bounds(world, soup, first)),
          windows(settings)
    {
    }

    /// Takes over the corners of the dynamic triangles.
    void move(World const& world)
    {
        if (earlier.corners.empty()) earlier.corners = corners_of(soup, first_moving);
        update_soup(world, first_moving, soup);
    }
    /// True if hit buffers of the schedule must be made anew, because dynamic triangles have left their bounds.
    bool outgrown(World const& world, Schedule schedule, Report& report)
    {
        if (!grow(grid_bounds, world.bounds)) return false;
        if (schedule != Schedule::streamed) // streamed buffers are rebuilt in every pass
            report.lose("frames outside the bounds of the hit buffers, which were rebuilt");
        return true;
    }
    /// Follows the cameras of views, see Windows::follow.
    template <class Views>
    bool place_windows(Views const& views)
    {
        std::vector<CameraRays> cameras;
        for (auto const& v : views) cameras.push_back(v.rays);
        return windows.follow(grid_bounds, soup, cameras);
    }
    void end_frame() { earlier = {first_moving, {}}; }

    std::size_t first_moving; ///< index of the first dynamic triangle
    TriangleSoup soup;
    CutOuts cut_outs;
    Bounds grid_bounds; ///< of the hit buffers
    Windows windows;
    EarlierCorners earlier;
};

/// A view as passes see it.
struct TracedView {
    /// The view from the next pass on. @return true if it continues the view of the previous frame
    bool follow(FrameView const& now, dvec3 origin, PixelFilter usual)
    {
        bool const known = width == now.width && height == now.height;
        width = now.width;
        height = now.height;
        rays = camera_rays(now.camera, width, height, origin);
        filter = now.filter.value_or(usual);
        hidden_pixels = now.hidden.size() - std::size_t(std::ranges::count(now.hidden, 0));
        if (!known) earlier = rays;
        return known;
    }
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }

    CameraRays rays{}, earlier{}; ///< through the centre of the lens; motion vectors refer to these
    int width = 0, height = 0;
    PixelFilter filter = PixelFilter::box;
    std::size_t hidden_pixels = 0;
};

/// True if paths also leave the last surface, as they can hit light there.
inline bool meets_light(World const& world)
{
    return !world.emitters.empty() || !view(world).environment_radiance.empty();
}

} // namespace gi
