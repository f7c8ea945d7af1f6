#include "gi/raster/grid.h"

#include <bit>

namespace gi {

RasterGrid make_grid(Bounds const& bounds, vec3 axis, std::uint32_t resolution, vec2 jitter, float turn_rad)
{
    return make_window(bounds, bounds, axis, resolution, jitter, turn_rad);
}

RasterGrid make_window(Bounds const& bounds, Bounds const& whole, vec3 axis, std::uint32_t resolution, vec2 jitter,
                       float turn_rad)
{
    constexpr float kLongestSide = 4; // longest side of a grid, as a multiple of the resolution
    RasterGrid g;
    Frame const frame = Frame::about(axis);
    float const c = std::cos(turn_rad), s = std::sin(turn_rad);
    g.right = c * frame.tangent + s * frame.bitangent;
    g.up = c * frame.bitangent - s * frame.tangent;
    g.axis = axis;
    if (bounds.empty()) return g;

    // Extent of a box along a direction: its half sizes weighted by the direction's components.
    vec3 const center = bounds.center(), half = 0.5f * (bounds.high - bounds.low);
    vec2 const middle{glm::dot(center, g.right), glm::dot(center, g.up)};
    vec2 reach{glm::dot(half, glm::abs(g.right)), glm::dot(half, glm::abs(g.up))};
    float const longest = glm::max(glm::max(reach.x, reach.y), 1e-30f);
    reach = glm::max(reach, vec2(longest / (kLongestSide * kLongestSide)));
    // Leaves one texel of margin for the jitter, and a little for rounding.
    float const texels = float(std::max(resolution, 2u) - 1) - 0.01f;
    g.texel = glm::max(2 * std::sqrt(reach.x * reach.y) / texels, 2 * longest / (kLongestSide * texels));
    g.corner = middle - reach - g.texel * (vec2(0.995f) * jitter + 0.0025f);
    g.width = std::uint32_t(2 * reach.x / g.texel + 1.01f) + 1;
    g.height = std::uint32_t(2 * reach.y / g.texel + 1.01f) + 1;
    // Coordinates of all that is drawn must fit, also beside the window.
    vec3 const all = 0.5f * (whole.high - whole.low), off = glm::abs(whole.center() - center);
    auto const beside = [&](vec3 along) {
        return std::uint32_t(glm::min((glm::dot(all + off, glm::abs(along))) / g.texel + 2, 0x1p30f));
    };
    std::uint32_t const side = std::max(g.width, g.height);
    int const bits = std::bit_width(&bounds == &whole ? side : side + std::max(beside(g.right), beside(g.up)));
    g.subpixels = float(1u << (RasterGrid::kCoordinateBits - std::min(bits, RasterGrid::kCoordinateBits - 1)));
    float const scale = g.subpixels / g.texel;
    g.to_x = scale * g.right;
    g.to_y = scale * g.up;
    g.x0 = -scale * g.corner.x;
    g.y0 = -scale * g.corner.y;
    g.rounding = 1e-6f * (glm::length(center) + bounds.radius());
    if (&bounds != &whole)
        g.rounding += 1e-7f * (glm::length(whole.center()) + whole.radius()); // of large triangles
    return g;
}

} // namespace gi
