#pragma once
// The first surfaces of a pass: one G-buffer of the whole picture, in which all pixels use the same subpixel
// position; it differs between passes, so that their mean contains the pixel filter.

#include "gi/methods/paths/tracer.h"
#include "gi/raster/cut_outs.h"
#include "gi/scene/model/projection.h"

#include <optional>
#include <span>

namespace gi {

/// Returns the subpixel position of a pass; (0, 0) is the pixel's corner.
vec2 place_in_pixel(PixelFilter filter, std::uint64_t seed, std::uint32_t pass);
/// Near plane distance, m.
inline float near_plane(Bounds const& bounds) { return 1e-5f * glm::max(bounds.radius(), 1e-30f); }

class PrimaryMap {
public:
    PrimaryMap(TriangleSoup const& soup, CutOuts const& cut_outs, RenderSettings const& settings, int width,
               int height);
    void set_filter(PixelFilter filter) { filter_ = filter; } ///< instead of the settings'

    /// Rasterises the view of a pass. @param camera  without a lens  @param near_m  distance of the near plane
    void refresh(CameraRays const& camera, float near_m, std::uint32_t pass);
    /// The same, and also keeps the view of only the triangles before `first_moving`.
    void refresh_pair(CameraRays const& camera, float near_m, std::uint32_t pass, std::size_t first_moving);
    /// Sets the view of a pass that was rasterised elsewhere. @param texels  row by row
    void take(CameraRays const& camera, std::uint32_t pass, std::vector<NearestTexel> texels);
    /// Returns the path starts of pixels first..last - 1, row by row.
    void hits(std::size_t first, std::size_t last, std::vector<PathStart>& out) const;
    /// The same for the given pixels without dynamic geometry; after refresh_pair.
    void hits_behind(std::span<std::uint32_t const> pixels, std::vector<PathStart>& out) const;

    /// Returns the pixel whose ray in this pass is nearest to a point; none if the point is outside the picture.
    std::optional<std::size_t> pixel_near(vec3 point) const;
    std::uint32_t triangle(std::size_t pixel) const { return map_.texels[pixel].primitive; }
    int width() const { return width_; }
    int height() const { return height_; }

private:
    void look_through(CameraRays const& camera, std::uint32_t pass);
    PerspectiveGrid start(CameraRays const& camera, float near_m, std::uint32_t pass);
    void draw(PerspectiveGrid const& grid, std::size_t first, std::size_t last, std::uint32_t pass);
    PathStart hit(NearestMap const& map, std::size_t x, std::size_t y) const;

    TriangleSoup const& soup_;
    CutOuts const& cut_outs_;
    CameraRays camera_{};
    int width_, height_;
    PixelFilter filter_;
    std::uint64_t seed_;
    Projection projection_;   ///< of the camera
    vec2 at_{0.5f};           ///< position in the pixel
    NearestMap map_, behind_; ///< the second without dynamic geometry
};

} // namespace gi
