#pragma once
// The shadow map of a light point: a cube of six pinhole views around a point, or orthographic views along a direction, of
// the whole and of windows with finer texels, each within the one before.
//
// Look-up: the depth of the lit surface's plane is compared with the stored depth at the same texel centre, so
// that flat and convex surfaces never shadow themselves. A surface only a few texels nearer to the light, such as
// a wall beside a floor, casts a shadow if the lit point is behind its plane: no bias, no tolerance.
// Percentage-closer filtering: one of the four surrounding texels is chosen at random, which averages to the
// bilinear filter over paths. Where the four disagree, an exact ray can decide instead (LitBy::some).

#include "gi/hit_buffers/shadow_maps/shadow_look.h"
#include "gi/raster/cut_outs.h"
#include "gi/scene/shading/light_sampling.h"

#include <array>

namespace gi {

struct ShadowMap {
    bool parallel = false; ///< light comes along grids[0].axis; else from the faces' eye point
    int levels = 1;        ///< if parallel: grids, the finest last
    std::array<RasterGrid, 6> grids;
    std::array<PerspectiveGrid, 6> faces;
    std::array<NearestMap, 6> maps; ///< of the faces, or of the levels

    using Place = ShadowPlace;
    /// Null if the face is empty.
    NearestTexel const* texels(std::size_t face) const
    {
        return maps[face].texels.empty() ? nullptr : maps[face].texels.data();
    }
    /// @param normal  unit, of the lit triangle  @param u uniform in [0, 1)^2
    Place look(vec3 position, vec3 normal, vec2 u) const;
    /// @param triangle  the lit triangle, at `position`
    bool lit(Place const& place, View<Surface const> surfaces, vec3 position, std::uint32_t triangle) const;
    /// True if one of the four texels around a point shows a triangle from `first` on.
    bool shows(vec3 position, vec3 normal, std::uint32_t first) const;
    LitBy lit_by(Place const& drawn, View<Surface const> surfaces, vec3 position, vec3 normal,
                 std::uint32_t triangle) const;
};

/// Parameters of a shadow map.
struct ShadowView {
    bool parallel = false;
    vec3 at{0};     ///< position of the light, or direction towards it
    vec3 facing{0}; ///< normal of a one-sided light, else 0
};

/// True if all directions of a face point behind a one-sided light, where it emits nothing.
bool sees_only_dark(ShadowView const& view, PerspectiveGrid const& face);

/// Per face: the texels overwritten by moving triangles, with their previous content,
/// so that these triangles can be removed again.
using TakenTexels = std::array<std::vector<std::pair<std::uint32_t, NearestTexel>>, 6>;

/// Builds shadow maps; the faces of a map are independent of each other.
class ShadowMapBuilder {
public:
    /// @param bounds  of all shadow casters  @param windows  of parallel maps, at most 5, see windows.h
    /// @param resolution  texels per side
    ShadowMapBuilder(Bounds const& bounds, std::vector<Bounds> windows, TriangleSoup const& soup,
                     CutOuts const& cut_outs, std::uint32_t resolution)
        : bounds_(bounds), windows_(std::move(windows)), soup_(soup), cut_outs_(cut_outs), resolution_(resolution)
    {
    }
    /// Prepares all grids of a map.
    void start(ShadowView const& view, vec2 jitter, float turn_rad, ShadowMap& map) const;
    /// Draws triangles 0..last - 1 into face 0..5; in parallel maps, into level 0..5.
    void build(ShadowView const& view, int face, std::size_t last, std::uint32_t seed, ShadowMap& map) const;
    /// Draws the triangles from `first` on into a face that contains the earlier ones; first restores the texels
    /// in `taken`, which they overwrote at an earlier moment.
    void move(int face, std::size_t first, std::uint32_t seed, ShadowMap& map, TakenTexels& taken) const;
    /// Removes them temporarily or puts them back, by swapping the texels with the saved content.
    static void swap_moving(int face, bool back, ShadowMap& map, TakenTexels& taken);

private:
    void draw(int face, std::size_t first, std::size_t last, std::uint32_t seed, ShadowMap const& map,
              Fragments& fragments) const;

    Bounds bounds_;
    std::vector<Bounds> windows_;
    TriangleSoup const& soup_;
    CutOuts const& cut_outs_;
    std::uint32_t resolution_;
};

} // namespace gi
