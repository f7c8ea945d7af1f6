#pragma once
// Direct light by the area formulation (Yu 2012, eq. 5.3): every pass draws a few light samples (points on lights
// or sky directions) in proportion to power; each gets a shadow map, and they light all paths of the pass.
// Neighbouring pixels use different ones (interleaved sampling), and so do other passes. In frame sequences some
// light points are kept for a while, and only dynamic geometry is redrawn into their maps.

#include "gi/render/light_order.h"
#include "gi/hit_buffers/shadow_maps/shadow_map.h"
#include "gi/render/pass_stop.h"

#include <functional>
#include <span>

namespace gi {

struct LightPoint {
    LightChoice choice;
    vec2 u{0}; ///< where on the light
    ShadowView view;
    LightSample light; ///< set if the light is infinitely distant, so that the sample is the same everywhere;
                       ///< else pdf = 0
    ShadowMap shadow;
    std::uint64_t number = ~std::uint64_t(0); ///< index of the point in the sequence
    TakenTexels taken;
};

struct LightPointSettings {
    /// Per pass; if all lights are point or parallel lights and there are no more than this, all of them.
    std::uint32_t count = 1;
    std::uint32_t fresh = 1; ///< of these, points replaced in every pass
    std::uint32_t resolution = 64; ///< texels per side of a shadow map
    std::vector<Bounds> windows{}; ///< of the maps of parallel lights, see windows.h
    std::uint64_t seed = 0;
    std::size_t first_moving = ~std::size_t(0); ///< index of the first triangle that may move
    StopRequest const* stop = nullptr;          ///< makes the constructor throw Interrupted; null = nothing does
};

class LightPoints {
public:
    /// @param bounds  of all shadow casters
    /// @param elsewhere  if set, this class only sets up the maps' grids, and the callback draws each map from
    ///   all triangles: maps of new light points, and all maps after dynamic geometry changes
    struct DeviceDraw {
        std::vector<LightPoint> const& light_points;
        std::vector<std::size_t> const& drawn; ///< of these
        std::uint32_t seed;                    ///< for partial coverage (cut-outs)
    };
    using DrawOnDevice = std::function<void(DeviceDraw const&)>;
    LightPoints(World const& world, Bounds const& bounds, TriangleSoup const& soup, CutOuts const& cut_outs,
                LightPointSettings const& settings, DrawOnDevice elsewhere = {});

    /// The triangles from LightPointSettings::first_moving on have moved.
    void moved() { moved_ = true; }
    /// Updates points and shadow maps for a pass. Pass numbers must increase. After Interrupted, which `stop`
    /// makes it throw, this object is of no more use.
    void refresh(std::uint32_t pass, PassStop const& stop = PassStop(nullptr));
    /// Puts dynamic geometry into the shadow maps or removes it; must be shown again before the next refresh.
    void show_moving(bool shown);
    std::vector<LightPoint> const& light_points() const { return light_points_; }
    bool none() const { return light_points_.empty(); }
    /// For picking a light point at a path vertex, if they are fixed(); else empty: all are equally likely.
    AliasTableView chances() const { return view(chances_); }
    bool fixed() const { return fixed_; }
    std::uint64_t maps_built() const { return built_; }

private:
    void take_point(LightPoint& light_point, std::uint64_t number);
    void build(std::span<LightPoint* const> fresh, std::uint32_t pass, PassStop const& stop);

    World const& world_;
    LightPointSettings settings_;
    ShadowMapBuilder builder_;
    std::size_t first_moving_;
    DrawOnDevice elsewhere_;
    bool fixed_ = false, moved_ = false;
    std::vector<LightPoint> light_points_;
    AliasTable chances_; ///< used if the points are fixed
    LightOrder order_;   ///< used otherwise
    std::uint64_t built_ = 0;
};

} // namespace gi
