#pragma once
// The first surfaces of a pass: one G-buffer of the whole picture, every pixel seen through the same point of it;
// passes differ in that point, so that their mean has the pixel filter.

#include "gi/methods/slhb/hit_buffer/cut_outs.h"
#include "gi/methods/slhb/tracer/tracer.h"
#include "gi/scene/model/projection.h"

#include <optional>
#include <span>

namespace gi {

/// The point of every pixel that a pass looks through, (0, 0) its corner.
vec2 place_in_pixel(PixelFilter filter, std::uint64_t seed, std::uint32_t pass);
/// Nothing nearer than this is seen, m.
inline float near_plane(Bounds const& bounds) { return 1e-5f * glm::max(bounds.radius(), 1e-30f); }

class PrimaryMap {
public:
    PrimaryMap(TriangleSoup const& soup, CutOuts const& cut_outs, RenderSettings const& settings, int width,
               int height);

    /// Rasterises the view of a pass. @param camera  without a lens  @param near_m  what is nearer is not seen
    void refresh(CameraRays const& camera, float near_m, std::uint32_t pass);
    /// The same, and keeps what is seen of the triangles before `first_moving` alone.
    void refresh_pair(CameraRays const& camera, float near_m, std::uint32_t pass, std::size_t first_moving);
    /// The view of a pass that was rasterised elsewhere. @param texels  in rows
    void take(CameraRays const& camera, std::uint32_t pass, std::vector<NearestTexel> texels);
    /// Of pixels first..last - 1, in rows.
    void hits(std::size_t first, std::size_t last, std::vector<PathStart>& out) const;
    /// Of pixels as they are without what moves; after refresh_pair.
    void hits_behind(std::span<std::uint32_t const> pixels, std::vector<PathStart>& out) const;

    /// The pixel whose ray of this pass goes nearest by a point; none where that is outside.
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
    NearestMap map_, behind_; ///< the second without what moves
};

} // namespace gi
