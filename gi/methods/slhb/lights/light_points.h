#pragma once
// Direct light by the area formulation (Yu 2012, eq. 5.3): in every pass a few points on lamps (or directions to
// the sky) are chosen by power, each gets a shadow map, and all paths of the pass are lit by them. Neighbouring
// pixels take different ones (interleaved sampling), other passes others. Where frames follow each other, some of
// the points stay for a while, and only what moves is drawn anew into their maps.

#include "gi/methods/slhb/lights/light_pool.h"
#include "gi/methods/slhb/lights/shadow_map.h"

#include <functional>
#include <span>

namespace gi {

struct LightPoint {
    LightChoice choice;
    vec2 u{0}; ///< where on the light
    ShadowView view;
    LightSample light; ///< where it shines from infinitely far away, the same everywhere; else pdf = 0
    ShadowMap shadow;
    std::uint64_t number = ~std::uint64_t(0); ///< of the point, among all of the sequence
    TakenTexels taken;
};

struct LightPointSettings {
    std::uint32_t count = 1; ///< in a pass; where all lights are points or parallel and no more than this, all
    std::uint32_t fresh = 1; ///< of these, other points in every pass
    std::uint32_t resolution = 64; ///< texels of a shadow map on a side
    std::uint64_t seed = 0;
    std::size_t first_moving = ~std::size_t(0); ///< triangle
};

class LightPoints {
public:
    /// @param bounds  of all that casts shadows
    /// @param elsewhere where it is not empty, shadow maps only get their grids here and are drawn there, of all
    /// that there is: of lamps that are new, and of all where something has moved
    struct DeviceDraw {
        std::vector<LightPoint> const& light_points;
        std::vector<std::size_t> const& drawn; ///< of these
        std::uint32_t seed;                    ///< for the cut-outs
    };
    using DrawOnDevice = std::function<void(DeviceDraw const&)>;
    LightPoints(World const& world, Bounds const& bounds, TriangleSoup const& soup, CutOuts const& cut_outs,
                LightPointSettings const& settings, DrawOnDevice elsewhere = {});

    /// The triangles from LampSettings::first_moving on are elsewhere.
    void moved() { moved_ = true; }
    /// The points and shadow maps of a pass. Passes count up.
    void refresh(std::uint32_t pass);
    /// What moves casts shadows, or is taken off the maps until it is shown again, before the next refresh.
    void show_moving(bool shown);
    std::vector<LightPoint> const& light_points() const { return light_points_; }
    bool none() const { return light_points_.empty(); }
    /// Probability of picking lamp k for a path vertex; their sum is 1.
    AliasTableView chances() const { return view(chances_); }
    bool fixed() const { return fixed_; }
    std::uint64_t maps_built() const { return built_; }

private:
    void take_point(LightPoint& light_point, std::uint64_t number);
    void build(std::span<LightPoint* const> fresh, std::uint32_t pass);

    World const& world_;
    LightPointSettings settings_;
    ShadowMapBuilder builder_;
    std::size_t first_moving_;
    DrawOnDevice elsewhere_;
    bool fixed_ = false, moved_ = false;
    std::vector<LightPoint> light_points_;
    AliasTable chances_; ///< where they are fixed
    LightOrder order_;   ///< else
    std::uint64_t built_ = 0;
};

} // namespace gi
