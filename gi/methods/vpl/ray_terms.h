#pragma once
// Visibility terms by exact rays.

#include "gi/methods/vpl/visibility_term.h"

namespace gi {

/// Rays towards the virtual light, limited to a radius. Unlimited, this is exact visibility; else directional
/// occlusion, in which occluders within the radius count, separately for each direction (after Sloan et al. 2007,
/// here with a ray per direction instead of spherical harmonics).
class RayTerm : public VisibilityTerm {
public:
    /// @param visibility  must outlive this object  @param radius_m  >= 0, kInf = unlimited
    RayTerm(ExactVisibility const& visibility, float radius_m) : visibility_(visibility), radius_m_(radius_m) {}
    void of_connections(ReceiverTile const& tile, std::span<Connection const> connections, std::span<float> shares,
                        PathCounts& counts) const override;
    void prepare(std::span<LightVertex const> lights, std::uint32_t, PassStop const&) override
    {
        lights_ = lights;
    }

private:
    ExactVisibility const& visibility_;
    float radius_m_;
    std::span<LightVertex const> lights_;
};

/// Ambient occlusion (Zhukov et al. 1998 without their falloff): A(x) = 1/pi times the integral of cos theta over
/// the directions of the hemisphere in which no surface is nearer than the radius. The estimate uses 4 stratified
/// rays per receiver; as light is linear in it, its noise averages out over passes like all other noise.
class AmbientTerm : public VisibilityTerm {
public:
    AmbientTerm(ExactVisibility const& visibility, float radius_m) : visibility_(visibility), radius_m_(radius_m)
    {
    }
    void of_receivers(ReceiverTile const& tile, std::span<float> shares, PathCounts& counts) const override;

private:
    ExactVisibility const& visibility_;
    float radius_m_;
};

} // namespace gi
