#include "ar/pipeline/prefiltered/occlusion_map.h"

#include "gi/raster/deep_raster.h"

namespace ar {

void OcclusionMap::start(gi::Bounds const& bounds, gi::vec3 towards, std::uint32_t texels, gi::vec2 jitter,
                         float turn_rad)
{
    shadow_.parallel = true;
    gi::RasterGrid& grid = shadow_.grids[0];
    grid = gi::make_grid(bounds, -towards, texels, jitter, turn_rad);
    gi::clear(shadow_.maps[0], grid.width, grid.height);
    to_x_ = grid.right / grid.texel;
    to_y_ = grid.up / grid.texel;
    x0_ = -grid.corner.x / grid.texel;
    y0_ = -grid.corner.y / grid.texel;
    width_ = float(grid.width);
    height_ = float(grid.height);
    texels_ = shadow_.maps[0].texels.data();
}

void OcclusionMap::draw(gi::TriangleSoup const& soup, gi::CutOuts const& cut_outs, std::size_t first,
                        std::size_t last, std::uint32_t seed)
{
    thread_local gi::Fragments drawn;
    drawn.count = 0;
    gi::rasterize(soup, first, last, shadow_.grids[0], gi::MacroPath::edge_table, drawn);
    cut_outs.remove(drawn, shadow_.grids[0], seed);
    gi::clear(shadow_.maps[0], shadow_.grids[0].width, shadow_.grids[0].height);
    gi::resolve(drawn, -1, shadow_.maps[0]);
    texels_ = shadow_.maps[0].texels.data();
}

float OcclusionMap::hidden(gi::View<gi::Surface const> surfaces, gi::vec3 p, gi::vec3 normal,
                           std::uint32_t triangle, std::uint32_t& blocker) const
{
    float const x = glm::dot(p, to_x_) + x0_, y = glm::dot(p, to_y_) + y0_;
    if (!(x > -1 && y > -1 && x < width_ + 1 && y < height_ + 1)) return 0;
    float const u = x - 0.5f - std::floor(x - 0.5f), v = y - 0.5f - std::floor(y - 0.5f);
    float share = 0;
    for (int k = 0; k < 4; ++k) {
        float const weight = (k & 1 ? u : 1 - u) * (k & 2 ? v : 1 - v);
        // The look-up takes floor(x - 0.5 + u) of its second argument: just below 1 is the upper neighbour.
        gi::vec2 const pick(k & 1 ? 0x1.fffffep-1f : 0.0f, k & 2 ? 0x1.fffffep-1f : 0.0f);
        gi::ShadowPlace const place = gi::shadow_detail::look(shadow_, p, normal, pick);
        if (gi::shadow_detail::lit(shadow_, place, surfaces, p, triangle)) continue;
        share += weight;
        blocker = place.texel->primitive;
    }
    return share;
}

} // namespace ar
