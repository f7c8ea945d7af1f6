#pragma once
// Visibility terms by exact rays.

#include "gi/methods/vpl/visibility_term.h"

namespace gi {

/// Rays to the virtual light, but no longer than a radius: all the way it is exact visibility; else directional
/// occlusion, by which occluders count along every direction by itself, and only those within the radius
/// (after Sloan et al. 2007, here with a ray for every direction instead of harmonics).
class RayTerm : public VisibilityTerm {
public:
    /// @param visibility  outlives this  @param radius_m  >= 0, kInf = all the way
    RayTerm(ExactVisibility const& visibility, float radius_m) : visibility_(visibility), radius_m_(radius_m) {}
    void of_connections(ReceiverTile const& tile, std::span<Connection const> connections, std::span<float> shares,
                        PathCounts& counts) const override;
    void prepare(std::span<VirtualLight const> lights, std::uint32_t) override { lights_ = lights; }

private:
    ExactVisibility const& visibility_;
    float radius_m_;
    std::span<VirtualLight const> lights_;
};

/// Ambient occlusion (Zhukov et al. 1998 without their falloff): A(x) = 1/pi times the integral over the
/// hemisphere of cos theta where nothing is nearer than the radius. A receiver's estimate has 4 rays, one for each
/// stratum; as light is linear in it, its noise averages away over passes like all other.
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
