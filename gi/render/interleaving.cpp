#include "gi/render/interleaving.h"

#include "gi/render/surface_likeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Light cannot be recovered from smaller albedos.
constexpr float kDarkest = 1e-3f;

/// Similarity between the surface of a waiting pixel and one that computed light. Never 0, so that small objects
/// without a similar neighbour still get light instead of turning dark.
float likeness(PathSample const& to, PathSample const& from)
{
    constexpr float kPlane = 0.005f; // distance to the plane, relative to the depth
    float const off = glm::dot(to.normal, from.position - to.position) / (kPlane * std::max(to.depth, 1e-6f));
    return kLeastLikeness + surface_likeness(to.normal, from.normal, off);
}

} // namespace

void spread_indirect(std::span<PathSample> samples, int width, Interleaving const& interleaving,
                     std::uint32_t pass)
{
    int const height = int(samples.size() / std::size_t(width)), n = int(interleaving.n);
    int const turn = int(interleaving.turn(pass)), column = turn % n, row = turn / n;
    float const share = 1 / float(n * n);
    // Pixels in turn at or before a position, and the next one after it; nearness = n - distance.
    struct Beside {
        std::array<int, 2> at, nearness;
    };
    auto const beside = [n](int x, int first) {
        int const after = (x - first + n) % n;
        return Beside{{x - after, x - after + n}, {n - after, after}};
    };
    tbb::parallel_for(0, height, [&](int y) {
        Beside const rows = beside(y, row);
        for (int x = 0; x < width; ++x) {
            PathSample& to = samples[std::size_t(y) * std::size_t(width) + std::size_t(x)];
            if (to.turn != IndirectTurn::waits) continue;
            Beside const columns = beside(x, column);
            vec3 sum{0};
            float weights = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                int const i = columns.at[k & 1], j = rows.at[k >> 1];
                if (i < 0 || j < 0 || i >= width || j >= height) continue;
                PathSample const& from = samples[std::size_t(j) * std::size_t(width) + std::size_t(i)];
                if (from.turn != IndirectTurn::taken) continue;
                float const weight = float(columns.nearness[k & 1] * rows.nearness[k >> 1]) * likeness(to, from);
                sum += weight * from.radiance[2] / glm::max(from.albedo, vec3{kDarkest});
                weights += weight;
            }
            if (weights > 0) to.radiance[2] += share / weights * sum * to.albedo;
        }
    });
    tbb::parallel_for(0, height, [&](int y) {
        for (PathSample& s : samples.subspan(std::size_t(y) * std::size_t(width), std::size_t(width)))
            if (s.turn == IndirectTurn::taken) s.radiance[2] *= share;
    });
}

int next_interleaving(int n, double budget_s, double frame_s, double indirect_s)
{
    constexpr double kMargin = 0.95; // frames with equal n vary by about 5 %
    double const rest = frame_s - indirect_s;
    auto const at = [&](int m) { return rest + indirect_s * n * n / double(m * m); };
    if (n < kMostInterleaving && frame_s > budget_s) return n + 1;
    return n > 1 && at(n - 1) < kMargin * budget_s ? n - 1 : n;
}

void FrameInterleaving::frame_begins()
{
    frame_ = pass_ = Clock::now();
    passes_s_ = 0;
}

void FrameInterleaving::pass_ended(double indirect)
{
    double const pass_s = seconds_since(pass_);
    passes_s_ += pass_s;
    pass_ = Clock::now();
    if (budget_s_ > 0) n_ = next_interleaving(n_, budget_s_, besides_s_ + pass_s, indirect * pass_s);
}

void FrameInterleaving::frame_ended() { besides_s_ = seconds_since(frame_) - passes_s_; }

} // namespace gi
