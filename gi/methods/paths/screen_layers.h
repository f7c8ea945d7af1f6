#pragma once
// A single layered hit buffer, in screen space: all surfaces along the view that the picture shows (Yu 2012, sec. 2.7;
// Nichols, Penmatsa and Wyman 2010). A ray walks through the texels that it crosses in the picture, and meets the
// polygons under their centres. What lies beside the view, or behind the eye, is met by no ray.

#include "gi/hit_buffers/query.h"
#include "gi/raster/cut_outs.h"

#include <optional>
#include <span>

namespace gi {

class ScreenLayers {
public:
    enum class Tiles : std::uint8_t { none, with_depths };
    /// Draws the view of triangles 0..last - 1 anew. @param eye  without a lens, not orthographic  @param width, height  of its picture, pixels
    /// @param texels  along the picture's longer side  @param at  place of the samples in a texel, [0, 1)^2
    /// @param near_m  distance of the near plane  @param seed  of the random decisions about partial coverage
    void draw(TriangleSoup const& soup, std::size_t last, CutOuts const& cut_outs, CameraRays const& eye,
              int width, int height, std::uint32_t texels, vec2 at, float near_m, std::uint32_t seed,
              Tiles tiles = Tiles::none);
    /// The nearest surface along a ray from a surface. @param triangle  where it starts
    /// @param watched  @param near_watched  set if a texel on the ray's way has a triangle from `watched` on
    LayerHit nearest(View<Surface const> surfaces, vec3 origin, std::uint32_t triangle, vec3 direction,
                     std::uint32_t watched, bool& near_watched) const;

    std::size_t size() const { return layers_.size(); }
    /// Texel t, row by row, has the layers first(t) to first(t + 1) - 1, in no order.
    std::uint32_t first(std::size_t t) const { return offset_[t]; }
    std::uint32_t triangle(std::uint32_t layer) const { return layers_[layer]; }
    /// The nearest layer of a texel that has any. If tiles were asked for.
    std::uint32_t front(std::size_t t) const { return front_[t]; }
    /// The texel that shows a point, with what its width is there, m; none beside the view.
    struct Texel {
        std::size_t index;
        float width_m;
    };
    std::optional<Texel> texel_at(vec3 point) const;
    /// Distances along the view, m, of the layers under kTile x kTile texels; without any, kInf and 0. If asked for.
    struct Depths {
        float nearest_m = kInf, farthest_m = 0;
    };
    static constexpr std::uint32_t kTile = 16;
    std::uint32_t columns() const { return grid_.width; }
    std::uint32_t tiles_across() const { return (grid_.width + kTile - 1) / kTile; }
    std::span<Depths const> tiles() const { return tiles_; }

private:
    PerspectiveGrid grid_;
    float texel_ = 0;                   ///< width of a texel, as a share of the distance along the view
    std::vector<std::uint32_t> offset_; ///< as in HitBuffer
    std::vector<std::uint32_t> layers_; ///< triangles, in no order
    std::vector<std::uint32_t> front_;  ///< per texel: index of a layer
    std::vector<Depths> tiles_;
};

} // namespace gi
