#pragma once
// Full-resolution pictures of the virtual objects from a pair rendered at a lower resolution: coverage is
// rasterised anew, and incident light comes from surrounding rendered pixels of similar surfaces (joint bilateral
// upsampling, Kopf et al. 2007). Mirrors and highlights on them keep the rendered resolution.

#include "ar/composite/upsample.h"
#include "ar/pipeline/first_surfaces.h"
#include "ar/pipeline/pair_renderer.h"

#include <memory>
#include <optional>
#include <vector>

namespace ar {

/// Pictures of the frame's size.
struct SharpSurfaces {
    DirectlySeen seen;           ///< with occlusion by proxies
    DirectlySeen unoccluded;     ///< without occlusion by proxies; empty unless requested
    std::size_t unlit = 0;       ///< points without a nearby rendered pixel of virtual objects, which become black
};

/// Virtual objects in one pixel of the frame: means over its points whose first surface is virtual.
struct VirtualPixel {
    cv::Vec3f normal, albedo;
    float depth_m = 0;
    int points = 0;        ///< number of these points
    bool is_split = false; ///< true if the points lie on surfaces that are not near each other
};

/// Light on virtual objects in a rendered pixel.
struct PixelLight {
    cv::Vec3f light, normal; ///< light: radiance over albedo
    float depth_m = 0;
    float coverage = 0; ///< 0: no virtual object in this pixel
};

template <class T>
struct PixelGrid {
    int rows = 0, cols = 0;
    std::vector<T> values;

    void create(cv::Size size)
    {
        rows = size.height;
        cols = size.width;
        values.resize(std::size_t(rows) * std::size_t(cols));
    }
    T& operator()(int y, int x) { return values[std::size_t(y) * std::size_t(cols) + std::size_t(x)]; }
    T const& operator()(int y, int x) const { return values[std::size_t(y) * std::size_t(cols) + std::size_t(x)]; }
};

class VirtualSurfaces {
public:
    /// @param world  must outlive this object, and have all virtual objects in place during calls
    explicit VirtualSurfaces(gi::World const& world) : world_(world), all_(world, Surfaces::all) {}

    /// Call after the world has moved.
    void moved();
    /// @param low   only direct and coverage are used  @param size  of the result, with the view of `camera`
    /// @return pictures whose memory the next call reuses
    SharpSurfaces at_size(PairPictures const& low, gi::Camera const& camera, cv::Size size, bool with_unoccluded);

private:
    void look(SurfaceView const& surfaces, gi::Camera const& camera, cv::Size size, cv::Rect region);
    void know(PairPictures const& low, cv::Size size, cv::Rect low_region, cv::Rect region);
    std::size_t light(SurfaceView const& surfaces, cv::Size low_size, cv::Size size, cv::Rect region,
                      DirectlySeen& to) const;
    std::optional<cv::Vec3f> light_at(cv::Vec2f place, cv::Vec3f const& normal, float depth_m) const;

    gi::World const& world_;
    SurfaceView all_;
    std::unique_ptr<SurfaceView> virtual_; ///< created on demand
    // Reused buffers.
    SurfaceRaster raster_;
    PixelGrid<VirtualPixel> pixels_; ///< of the region
    PixelGrid<PixelLight> known_;    ///< of the rendered size
    SharpSurfaces out_;
};

/// Guides of real surfaces at full size, and at the rendered size as means over full-size pixels.
class RealSurfaces {
public:
    explicit RealSurfaces(gi::World const& world) : real_(world, Surfaces::still) {}

    /// @param wanted  CV_8UC1, of the rendered size: guides are computed where it
    /// is nonzero and undefined elsewhere
    void look(gi::Camera const& camera, cv::Size size, cv::Mat const& wanted);
    /// Valid until the next `look`, which reuses their memory.
    SurfaceGuides const& guides() const { return guides_; }
    SurfaceGuides const& low_guides() const { return low_; }

private:
    SurfaceView real_;
    SurfaceRaster raster_;
    SurfaceGuides guides_, low_;
};

/// Bounding rectangle of nonzero pixels, enlarged by `by_px`; empty if all are 0.
cv::Rect around(cv::Mat const& mask, int by_px);
/// Scales a rectangle from one picture size to another.
cv::Rect scaled(cv::Rect rectangle, cv::Size from, cv::Size to);

} // namespace ar
