#include "gi/methods/vpl/gather.h"

namespace gi {
namespace {

/// Number of connections tested together.
constexpr std::size_t kTogether = 4096;

/// Receivers as arrays, so that one virtual light is combined with several receivers per SIMD vector; and their
/// geometry relative to it.
struct alignas(64) Lanes {
    static constexpr std::size_t kMost = 256;
    using Array = float[kMost];

    Array x, y, z;    ///< m
    Array gx, gy, gz; ///< geometric normals
    Array sx, sy, sz; ///< shading normals
    // Relative to one light:
    Array dx, dy, dz; ///< unit, towards it
    Array squared;    ///< distance, m^2
    Array cos_light;  ///< geometric, at the light
    Array cos;        ///< with the shading normal; 0 = they do not face each other

    void set(std::size_t k, Receiver const& r)
    {
        x[k] = r.position.x, y[k] = r.position.y, z[k] = r.position.z;
        gx[k] = r.geometric_normal.x, gy[k] = r.geometric_normal.y, gz[k] = r.geometric_normal.z;
        sx[k] = r.frame.normal.x, sy[k] = r.frame.normal.y, sz[k] = r.frame.normal.z;
    }
    /// Without branches, so that it vectorises.
    void meet(LightVertex const& light, std::size_t count)
    {
        vec3 const p = light.position, n = light.normal;
        for (std::size_t k = 0; k < count; ++k) {
            float const wx = p.x - x[k], wy = p.y - y[k], wz = p.z - z[k];
            float const length2 = wx * wx + wy * wy + wz * wz;
            float const inverse = 1 / std::sqrt(length2);
            float const facing = -inverse * (wx * n.x + wy * n.y + wz * n.z);
            float const above = wx * gx[k] + wy * gy[k] + wz * gz[k];
            float const cosine = inverse * (wx * sx[k] + wy * sy[k] + wz * sz[k]);
            bool const meets = (facing > 0) & (above > 0) & (cosine > 0);
            dx[k] = inverse * wx;
            dy[k] = inverse * wy;
            dz[k] = inverse * wz;
            squared[k] = length2;
            cos_light[k] = facing;
            cos[k] = meets ? cosine : 0;
        }
    }
};

/// pi f of a receiver towards a virtual light.
vec3 at_receiver(Receiver const& r, vec3 direction)
{
    return r.matt ? r.bsdf.diffuse : kPi * evaluate(r.bsdf, r.wo, r.frame.to_local(direction)).f;
}

/// pi f of a virtual light towards a receiver. @param direction  from the receiver
vec3 at_light(LightVertex const& light, vec3 direction)
{
    if (light.matt) return light.bsdf.diffuse;
    vec3 const leaves = light.frame.to_local(-direction);
    return leaves.z > 0 ? kPi * evaluate(light.bsdf, light.arrived, leaves).f : vec3{0};
}

struct Waiting {
    std::vector<Connection> connections;
    std::vector<vec3> light; ///< that arrives if unblocked
    std::vector<float> shares;

    void flush(ReceiverTile const& tile, VisibilityTerm const& term, std::span<vec3> sums, PathCounts& paths)
    {
        shares.resize(connections.size());
        term.of_connections(tile, connections, shares, paths);
        for (std::size_t k = 0; k < connections.size(); ++k) sums[connections[k].receiver] += shares[k] * light[k];
        connections.clear();
        light.clear();
    }
};

} // namespace

void gather(ReceiverTile const& tile, std::span<LightVertex const> lights, VisibilityTerm const& term, float bound,
            PassStop const& stop, std::span<vec3> radiance, PathCounts& paths, GatherCounts& counts)
{
    if (lights.empty() || tile.receivers.empty()) return;
    thread_local Waiting waiting;
    thread_local std::vector<vec3> sums;
    thread_local std::vector<float> shares;
    thread_local Lanes lanes;
    std::size_t const all = tile.receivers.size();
    sums.assign(all, vec3{0});
    waiting.connections.clear(); // of a tile that was given up
    waiting.light.clear();
    for (std::size_t first = 0; first < all; first += Lanes::kMost) {
        std::size_t const count = std::min(Lanes::kMost, all - first);
        for (std::size_t k = 0; k < count; ++k) lanes.set(k, tile.receivers[first + k]);
        for (std::uint32_t l = 0; l < lights.size(); ++l) {
            LightVertex const& light = lights[l];
            lanes.meet(light, count);
            for (std::size_t k = 0; k < count; ++k) {
                if (!(lanes.cos[k] > 0)) continue;
                auto const receiver = std::uint32_t(first + k);
                vec3 const direction{lanes.dx[k], lanes.dy[k], lanes.dz[k]};
                vec3 const f = at_receiver(tile.receivers[receiver], direction);
                float const most = max_component(f);
                if (!(most > 0)) continue;
                float const h = bounded_term(most * lanes.cos[k], lanes.cos_light[k], lanes.squared[k]);
                float const share = share_of_virtual_lights(h, bound);
                counts.bounded += share < 1 ? 1 : 0;
                float const geometry =
                    share * lanes.cos[k] * lanes.cos_light[k] / lanes.squared[k] * (kInvPi * kInvPi);
                waiting.connections.push_back({receiver, l, direction});
                waiting.light.push_back(f * at_light(light, direction) * light.power * geometry);
            }
            if (waiting.connections.size() < kTogether) continue;
            stop.check();
            counts.connections += waiting.connections.size();
            waiting.flush(tile, term, sums, paths);
        }
    }
    counts.connections += waiting.connections.size();
    waiting.flush(tile, term, sums, paths);
    shares.resize(all);
    term.of_receivers(tile, shares, paths);
    for (std::size_t k = 0; k < all; ++k) {
        vec3 const light = tile.receivers[k].throughput * (shares[k] * sums[k]);
        if (all_finite(light))
            radiance[k] += light;
        else
            ++paths.invalid_paths;
    }
}

} // namespace gi
