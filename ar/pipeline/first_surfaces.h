#pragma once
// What a camera sees first at every pixel, without any light: rasterised, so it costs little beside a pass of
// paths.

#include "gi/methods/slhb/lights/primary_map.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

#include <opencv2/core.hpp>

namespace viewer {

/// Which surfaces there are for a picture.
enum class Surfaces {
    all,
    still, ///< those that cannot move: what is real
    moving ///< those that can: what is virtual
};

/// Of one point of every pixel.
struct FirstSurfaces {
    cv::Mat triangle; ///< CV_32SC1, of the world; -1 = none
    cv::Mat depth_m;  ///< CV_32FC1, along the axis; 0 = none
    cv::Mat normal;   ///< CV_32FC3, length 1, towards the camera; 0 = none
    cv::Mat albedo;   ///< CV_32FC3
    cv::Mat place;    ///< CV_32FC2, the first texture coordinates, as the material's base colour reads them
};

/// What is nearest at a raster of points, with nothing looked up yet.
struct SurfaceRaster {
    cv::Rect region;     ///< of the raster that the camera sees: what was looked at
    gi::CameraRays rays; ///< of the whole raster, a point (x, y) at x + 0.5, y + 0.5
    gi::NearestMap map;  ///< of the region

    gi::NearestTexel const& texel(int x, int y) const
    {
        return map.texels[std::size_t(y - region.y) * map.width + std::size_t(x - region.x)];
    }
};

/// One point of a surface.
struct FirstSurface {
    gi::vec3 normal, albedo;
    float depth_m = 0; ///< along the axis
};

class SurfaceView {
public:
    /// Reads the world's triangles as they are now. @param world  outlives this
    SurfaceView(gi::World const& world, Surfaces surfaces);
    /// Reads triangles that can move again.
    void moved();

    /// @param camera  perspective
    /// @param pass  which point of the pixels, as in gi's passes: another one, another point
    /// @param region  of the picture; without it, all. Elsewhere there is nothing
    /// @param wanted  of what is seen first: others are left out of the result, but hide what is behind them
    FirstSurfaces seen(gi::Camera const& camera, int width, int height, std::uint32_t pass, cv::Rect region = {},
                       Surfaces wanted = Surfaces::all) const;
    /// @param into  its memory is used again
    void rasterise(gi::Camera const& camera, int width, int height, cv::Rect region, SurfaceRaster& into) const;
    /// Of the triangle of a texel, at a position of the raster: the nearest point of it.
    FirstSurface surface_at(SurfaceRaster const& raster, gi::NearestTexel const& texel, gi::vec2 position) const;
    bool is_still(gi::NearestTexel const& texel) const { return texel.primitive < world_.static_triangles; }

private:
    void hide();

    gi::World const& world_;
    Surfaces surfaces_;
    gi::TriangleSoup soup_;
    gi::CutOuts cut_outs_;
};

} // namespace viewer
