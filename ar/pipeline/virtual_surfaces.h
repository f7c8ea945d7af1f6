#pragma once
// What virtual things show themselves, at the frame's size, from a pair that was rendered at a lower one: which
// pixels they cover is rasterised anew, and the light that falls on them is that of the rendered pixels around
// which show a like surface (joint bilateral upsampling, Kopf et al. 2007). Mirrors and highlights on them stay as
// coarse as they were rendered.

#include "ar/composite/upsample.h"
#include "ar/pipeline/first_surfaces.h"
#include "ar/pipeline/pair_renderer.h"

#include <memory>
#include <optional>
#include <vector>

namespace viewer {

/// Each of the frame's size.
struct SharpSurfaces {
    ar::DirectlySeen seen;       ///< less what proxies hide
    ar::DirectlySeen unoccluded; ///< as if proxies hid nothing; empty unless asked for
    std::size_t unlit = 0; ///< points of pixels without any rendered pixel near by that shows the things: black
};

/// Virtual things in one pixel of the frame: means over the points of it where they are seen first.
struct VirtualPixel {
    cv::Vec3f normal, albedo;
    float depth_m = 0;
    int points = 0;        ///< of it, where they are seen
    bool is_split = false; ///< between surfaces that are not near each other
};

/// What a rendered pixel knows of virtual things.
struct PixelLight {
    cv::Vec3f light, normal; ///< light: radiance over albedo
    float depth_m = 0;
    float coverage = 0; ///< 0: it knows nothing
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
    /// @param world  outlives this; with everything that is virtual in its place when it is asked
    explicit VirtualSurfaces(gi::World const& world) : world_(world), all_(world, Surfaces::all) {}

    /// The world has moved.
    void moved();
    /// @param low   direct and coverage are read  @param size  of the result; sees what `camera` does
    /// @return pictures whose memory the next call uses again
    SharpSurfaces at_size(PairPictures const& low, gi::Camera const& camera, cv::Size size, bool with_unoccluded);

private:
    void look(SurfaceView const& surfaces, gi::Camera const& camera, cv::Size size, cv::Rect region);
    void know(PairPictures const& low, cv::Size size, cv::Rect low_region, cv::Rect region);
    std::size_t light(SurfaceView const& surfaces, cv::Size low_size, cv::Size size, cv::Rect region,
                      ar::DirectlySeen& to) const;
    std::optional<cv::Vec3f> light_at(cv::Vec2f place, cv::Vec3f const& normal, float depth_m) const;

    gi::World const& world_;
    SurfaceView all_;
    std::unique_ptr<SurfaceView> virtual_; ///< made when it is asked for
    // Memory of the last call.
    SurfaceRaster raster_;
    PixelGrid<VirtualPixel> pixels_; ///< of the region
    PixelGrid<PixelLight> known_;    ///< of the rendered size
    SharpSurfaces out_;
};

/// Guides of real surfaces for a picture and the rendered one, whose pixels are means over those of the picture.
class RealSurfaces {
public:
    explicit RealSurfaces(gi::World const& world) : real_(world, Surfaces::still) {}

    /// @param wanted  CV_8UC1, of the rendered size: where it is not 0; elsewhere guides are anything
    void look(gi::Camera const& camera, cv::Size size, cv::Mat const& wanted);
    /// Their memory is used again by the next look.
    ar::SurfaceGuides const& guides() const { return guides_; }
    ar::SurfaceGuides const& low_guides() const { return low_; }

private:
    SurfaceView real_;
    SurfaceRaster raster_;
    ar::SurfaceGuides guides_, low_;
};

/// The rectangle of what is not 0, wider by some pixels; empty where all is.
cv::Rect around(cv::Mat const& mask, int by_px);
/// What of a picture of another size a rectangle covers.
cv::Rect scaled(cv::Rect rectangle, cv::Size from, cv::Size to);

} // namespace viewer
