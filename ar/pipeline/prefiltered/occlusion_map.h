#pragma once
// The nearest surfaces along one direction, for many look-ups: an orthographic depth map (gi's shadow map of a
// parallel light) with a quick answer where nothing is drawn.

#include "gi/hit_buffers/shadow_maps/shadow_map.h"

namespace ar {

class OcclusionMap {
public:
    /// Sets up an empty map. @param towards  unit, to the light: the map keeps what is nearest to it
    /// @param bounds  of what will be drawn  @param texels  per side
    void start(gi::Bounds const& bounds, gi::vec3 towards, std::uint32_t texels, gi::vec2 jitter, float turn_rad);
    /// Replaces the content by triangles first..last - 1.
    void draw(gi::TriangleSoup const& soup, gi::CutOuts const& cut_outs, std::size_t first, std::size_t last,
              std::uint32_t seed);

    /// The texel that contains a point; nothing drawn there: null.
    gi::NearestTexel const* texel(gi::vec3 p) const
    {
        float const x = glm::dot(p, to_x_) + x0_, y = glm::dot(p, to_y_) + y0_;
        if (!(x >= 0 && y >= 0 && x < width_ && y < height_)) return nullptr;
        gi::NearestTexel const* const t = texels_ + (std::size_t(y) * shadow_.grids[0].width + std::size_t(x));
        return t->primitive == gi::kNoPrimitive ? nullptr : t;
    }
    /// The triangle that hides the light from a point, kNoPrimitive = none.
    /// @param normal  unit, of the lit triangle  @param triangle  the lit one; kNoPrimitive = a point in space
    std::uint32_t blocker(gi::View<gi::Surface const> surfaces, gi::vec3 p, gi::vec3 normal,
                          std::uint32_t triangle) const
    {
        gi::NearestTexel const* const t = texel(p);
        if (t == nullptr) return gi::kNoPrimitive;
        // Beyond this, the look-up below, which allows for slopes, decides the same.
        constexpr float kFar = 12; // texels
        float const gap = shadow_.grids[0].depth(p) + t->key;
        bool const is_free = triangle == gi::kNoPrimitive; // a point in space has no slope
        if (is_free || std::abs(gap) > kFar * shadow_.grids[0].texel)
            return gap > 0 ? t->primitive : gi::kNoPrimitive;
        gi::ShadowPlace const place = gi::shadow_detail::look(shadow_, p, normal, gi::vec2(0.5f));
        if (gi::shadow_detail::lit(shadow_, place, surfaces, p, triangle)) return gi::kNoPrimitive;
        return place.texel->primitive;
    }
    /// Share of the light that is hidden, by the four nearest texels (percentage-closer filtering, Reeves 1987).
    float hidden(gi::View<gi::Surface const> surfaces, gi::vec3 p, gi::vec3 normal, std::uint32_t triangle,
                 std::uint32_t& blocker) const;
    gi::RasterGrid const& grid() const { return shadow_.grids[0]; }
    std::vector<gi::NearestTexel> const& texels() const { return shadow_.maps[0].texels; }

private:
    gi::ShadowMap shadow_;
    gi::vec3 to_x_{0}, to_y_{0}; ///< world to texels
    float x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
    gi::NearestTexel const* texels_ = nullptr;
};

} // namespace ar
