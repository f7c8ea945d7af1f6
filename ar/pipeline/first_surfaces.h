#pragma once
// First surfaces of a camera's view, without lighting: rasterised, so the cost is small compared with a pass.

#include "gi/methods/paths/primary_map.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

#include <opencv2/core.hpp>

namespace ar {

/// Surfaces to include in a picture.
enum class Surfaces {
    all,
    still, ///< surfaces that cannot move: real ones
    moving ///< surfaces that can move: virtual ones
};

/// First surfaces at one point of every pixel.
struct FirstSurfaces {
    cv::Mat triangle; ///< CV_32SC1, triangle index in the world; -1 = none
    cv::Mat depth_m;  ///< CV_32FC1, along the axis; 0 = none
    cv::Mat normal;   ///< CV_32FC3, length 1, towards the camera; 0 = none
    cv::Mat albedo;   ///< CV_32FC3
    cv::Mat place;    ///< CV_32FC2, first texture coordinates, as used by the material's base colour
};

/// Nearest triangles at a raster of points, before surface attributes are fetched.
struct SurfaceRaster {
    cv::Rect region;     ///< rasterised part of the camera's raster
    gi::CameraRays rays; ///< of the whole raster; point (x, y) is at x + 0.5, y + 0.5
    gi::NearestMap map;  ///< of the region
    gi::WorldView world; ///< valid until the world changes

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
    /// Reads the world's current triangles. @param world  must outlive this object
    SurfaceView(gi::World const& world, Surfaces surfaces);
    /// Reads the movable triangles again.
    void moved();

    /// @param camera  perspective
    /// @param pass  selects the sample point within the pixels, as in gi's passes
    /// @param region  part of the picture to compute; default: all. The rest of the result is empty
    /// @param wanted  surfaces to return; others are left out of the result, but still occlude
    FirstSurfaces seen(gi::Camera const& camera, int width, int height, std::uint32_t pass, cv::Rect region = {},
                       Surfaces wanted = Surfaces::all) const;
    /// @param into  result; its memory is reused
    void rasterise(gi::Camera const& camera, int width, int height, cv::Rect region, SurfaceRaster& into) const;
    /// The point of the texel's triangle that is nearest to a position of the raster.
    FirstSurface surface_at(SurfaceRaster const& raster, gi::NearestTexel const& texel, gi::vec2 position) const;
    bool is_still(gi::NearestTexel const& texel) const { return texel.primitive < world_.static_triangles; }

private:
    void hide();

    gi::World const& world_;
    Surfaces surfaces_;
    gi::TriangleSoup soup_;
    gi::CutOuts cut_outs_;
};

} // namespace ar
