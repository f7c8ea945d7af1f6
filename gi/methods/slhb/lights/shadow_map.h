#pragma once
// What a lamp sees: a cube of six pinhole views about a point, or one orthographic view along a direction.
//
// Look-up: the plane of the lit surface is compared with the stored depth at the same texel centre, so that flat
// and convex surfaces never shadow themselves. What lies nearer to the lamp by a few texels only, as the wall does
// beside a floor, casts a shadow if the lit point is behind its plane: no bias, no tolerance. Percentage-closer
// filtering: the texel is chosen among the four around by random numbers, which in the mean over paths is the
// bilinear filter.

#include "gi/methods/slhb/hit_buffer/cut_outs.h"
#include "gi/methods/slhb/lights/shadow_look.h"
#include "gi/scene/shading/light_sampling.h"

#include <array>

namespace gi {

struct ShadowMap {
    bool parallel = false; ///< all light comes along axis; else from the eye of the faces
    RasterGrid grid;
    std::array<PerspectiveGrid, 6> faces;
    std::array<NearestMap, 6> maps; ///< [0] alone where parallel

    using Place = ShadowPlace;
    /// Null where the face is empty.
    NearestTexel const* texels(std::size_t face) const
    {
        return maps[face].texels.empty() ? nullptr : maps[face].texels.data();
    }
    /// @param normal  unit, of the lit triangle  @param u uniform in [0, 1)^2
    Place look(vec3 position, vec3 normal, vec2 u) const;
    /// @param triangle  that is lit, at `position`
    bool lit(Place const& place, View<Surface const> surfaces, vec3 position, std::uint32_t triangle) const;
};

/// Everything that decides a shadow map.
struct ShadowView {
    bool parallel = false;
    vec3 at{0};     ///< position of the lamp, or direction towards it
    vec3 facing{0}; ///< a lamp that shines to one side only: its normal, else 0
};

/// Whether a face's every direction points behind the lamp, where it lights nothing.
bool sees_only_dark(ShadowView const& view, PerspectiveGrid const& face);

/// What is under the texels that moving triangles took, face by face: to take those off again.
using TakenTexels = std::array<std::vector<std::pair<std::uint32_t, NearestTexel>>, 6>;

/// Faces of a map are independent of each other.
class ShadowMapBuilder {
public:
    /// @param bounds  of all that casts shadows  @param resolution  texels on a side
    ShadowMapBuilder(Bounds const& bounds, TriangleSoup const& soup, CutOuts const& cut_outs,
                     std::uint32_t resolution)
        : bounds_(bounds), soup_(soup), cut_outs_(cut_outs), resolution_(resolution)
    {
    }
    /// Prepares all grids of a map.
    void start(ShadowView const& view, vec2 jitter, float turn_rad, ShadowMap& map) const;
    /// Face 0..5 of it, of triangles 0..last - 1; parallel maps have only face 0.
    void build(ShadowView const& view, int face, std::size_t last, std::uint32_t seed, ShadowMap& map) const;
    /// The triangles from `first` on are drawn into a face that has those before, where `taken` is what those of
    /// an earlier moment took.
    void move(int face, std::size_t first, std::uint32_t seed, ShadowMap& map, TakenTexels& taken) const;
    /// Takes them off for a while, or puts them back: texels and what is under them change places.
    static void swap_moving(int face, bool back, ShadowMap& map, TakenTexels& taken);

private:
    void draw(int face, std::size_t first, std::size_t last, std::uint32_t seed, ShadowMap const& map,
              Fragments& fragments) const;

    Bounds bounds_;
    TriangleSoup const& soup_;
    CutOuts const& cut_outs_;
    std::uint32_t resolution_;
};

} // namespace gi
