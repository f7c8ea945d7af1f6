#include "gi/methods/vpl/ray_terms.h"

#include "gi/core/rqmc.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>

namespace gi {

void RayTerm::of_connections(ReceiverTile const& tile, std::span<Connection const> connections,
                             std::span<float> shares, PathCounts& counts) const
{
    if (!(radius_m_ > 0)) return VisibilityTerm::of_connections(tile, connections, shares, counts);
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<std::uint8_t> blocked;
    rays.clear();
    for (Connection const& c : connections) {
        Receiver const& r = tile.receivers[c.receiver];
        LightVertex const& light = lights_[c.light];
        vec3 const from = r.position + r.clearance * r.geometric_normal;
        vec3 const way = light.position + light.clearance * light.normal - from;
        float const length = glm::length(way);
        rays.push_back({.ray = {from, length > 0 ? way / length : c.direction},
                        .reach = std::min(length * (1 - 2e-5f), radius_m_),
                        .seed = hash_words(tile.seed + c.receiver, c.light)});
    }
    blocked.resize(rays.size());
    visibility_.occluded(rays, blocked);
    counts.shadow_rays += rays.size();
    for (std::size_t k = 0; k < blocked.size(); ++k)
        shares[k] = blocked[k] != 0 && rays[k].reach > 0 ? 0.0f : 1.0f;
}

void AmbientTerm::of_receivers(ReceiverTile const& tile, std::span<float> shares, PathCounts& counts) const
{
    if (!(radius_m_ > 0)) return VisibilityTerm::of_receivers(tile, shares, counts);
    constexpr int kAcross = 2, kRays = kAcross * kAcross;
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<std::uint8_t> blocked;
    rays.clear();
    for (std::uint32_t k = 0; k < tile.receivers.size(); ++k) {
        Receiver const& r = tile.receivers[k];
        Pcg32 rng = Pcg32::for_path(0xa0, tile.seed, k);
        for (int i = 0; i < kRays; ++i) {
            vec2 const u = (vec2{float(i % kAcross), float(i / kAcross)} + rng.uniform2()) / float(kAcross);
            vec3 const direction = r.frame.to_world(square_to_cosine_hemisphere(u));
            // Directions behind the triangle (due to the shading normal) are not part of its hemisphere.
            bool const above = glm::dot(direction, r.geometric_normal) > 0;
            rays.push_back({.ray = {r.position + r.clearance * r.geometric_normal, direction},
                            .reach = above ? radius_m_ : 0.0f,
                            .seed = rng.next()});
        }
    }
    blocked.resize(rays.size());
    visibility_.occluded(rays, blocked);
    counts.shadow_rays += rays.size();
    for (std::size_t k = 0; k < shares.size(); ++k) {
        int is_free = 0;
        for (std::size_t i = 0; i < kRays; ++i) is_free += blocked[kRays * k + i] == 0 ? 1 : 0;
        shares[k] = float(is_free) / kRays;
    }
}

} // namespace gi
