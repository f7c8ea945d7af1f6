#include "gi/light_paths/kernel_cover.h"

#include "gi/core/rng.h"
#include "gi/render/flush_denormals.h"

#include <algorithm>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kFew = 4, kMany = 16; ///< rays on a kernel

/// The largest disk about a point that its triangle holds, m.
float room_on_triangle(Surface const& s, vec3 point)
{
    vec3 const corners[3] = {s.corner, s.corner + s.edge1, s.corner + s.edge2};
    float room = kInf;
    for (int k = 0; k < 3; ++k) {
        vec3 const edge = corners[(k + 1) % 3] - corners[k];
        float const length = glm::length(edge);
        if (!(length > 0)) return 0;
        room = std::min(room, glm::length(glm::cross(edge, point - corners[k])) / length);
    }
    return room;
}

/// Ray k of `of` onto a kernel; together they are distributed as its weight is.
RayQuery ray_onto(PhotonKernel const& kernel, int k, int of, float turn)
{
    float const u = (float(k) + 0.5f) / float(of);
    float const distance = kernel.radius * std::sqrt(1 - std::sqrt(1 - u));
    float const angle = 2 * kPi * (turn + 0.61803399f * float(k));
    Frame const frame = Frame::about(kernel.normal);
    float const height = PhotonKernel::kFromPlane * kernel.radius;
    vec3 const at =
        kernel.position + distance * (std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent);
    return {.ray = {at + height * kernel.normal, -kernel.normal}, .reach = 2 * height, .seed = std::uint32_t(k)};
}

bool is_on_surface(WorldView const& world, Hit const& hit, vec3 normal)
{
    if (hit.triangle == kNoTriangle) return false;
    Surface const& s = world.surfaces[hit.triangle];
    vec3 const across = glm::cross(s.edge1, s.edge2);
    return std::abs(glm::dot(across, normal)) >= PhotonKernel::kSameWay * glm::length(across);
}

} // namespace

std::vector<float> covered_shares(WorldView const& world, ExactVisibility const& visibility,
                                  std::span<Photon const> photons, std::span<PhotonKernel const> kernels,
                                  BuildStop const& stop, PathCounts& counts)
{
    constexpr std::size_t kTogether = 256;
    std::vector<float> shares(kernels.size(), 1);
    tbb::combinable<std::uint64_t> rays([] { return std::uint64_t(0); });
    std::size_t const blocks = (kernels.size() + kTogether - 1) / kTogether;
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
        FlushDenormals const guard;
        if (stop.given_up()) throw Interrupted();
        std::vector<std::uint32_t> open;
        std::vector<RayQuery> queries;
        std::vector<Hit> hits;
        auto const test = [&](int of) {
            queries.clear();
            for (std::uint32_t const i : open)
                for (int k = 0; k < of; ++k)
                    queries.push_back(ray_onto(kernels[i], k, of, float(mix_bits(i) >> 40) * 0x1p-24f));
            hits.resize(queries.size());
            visibility.nearest(queries, hits);
            rays.local() += queries.size();
            std::vector<std::uint32_t> partly;
            for (std::size_t n = 0; n < open.size(); ++n) {
                int met = 0;
                for (int k = 0; k < of; ++k)
                    met +=
                        is_on_surface(world, hits[n * std::size_t(of) + std::size_t(k)], kernels[open[n]].normal);
                shares[open[n]] = (float(met) + 0.5f) / (float(of) + 0.5f);
                if (met < of) partly.push_back(open[n]);
            }
            open = std::move(partly);
        };
        std::size_t const begin = block * kTogether, end = std::min(kernels.size(), begin + kTogether);
        for (std::size_t i = begin; i < end; ++i)
            if (room_on_triangle(world.surfaces[photons[i].triangle], kernels[i].position) < kernels[i].radius)
                open.push_back(std::uint32_t(i));
        test(kFew);
        if (!open.empty()) test(kMany);
    });
    counts.nearest_rays += rays.combine(std::plus<>());
    return shares;
}

} // namespace gi
