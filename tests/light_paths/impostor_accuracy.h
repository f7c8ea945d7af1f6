#pragma once
// How distance impostors answer rays of light paths, beside exact rays: of tests and of bench_impostor_rays.

#include "gi/core/quantile.h"
#include "gi/light_paths/impostor_rays.h"
#include "gi/light_paths/reached_points.h"

#include <algorithm>

namespace gi::test {

/// Cosine-distributed rays that leave surfaces which light or cameras reach.
inline std::vector<PathQuery> rays_of_light(World const& world, ExactVisibility const& visibility, std::size_t n,
                                            std::uint64_t seed)
{
    std::vector<PathQuery> rays;
    std::vector<Flight> const all = reach(world, visibility, n / 8 + 64, seed).flights;
    n = std::min(n, all.size());
    for (std::size_t k = 0; k < n; ++k) {
        Flight const& f = all[k * all.size() / n];
        rays.push_back({{.ray = {f.from, f.direction}, .seed = std::uint32_t(k)}, f.leaves});
    }
    return rays;
}

/// How the answers of a search differ from those of exact rays.
struct Accuracy {
    double wrong = 0; ///< share: a surface where there is none, the reverse, or another triangle and > 2 % off
    double lost = 0, extra = 0;   ///< shares: nothing though there is a surface, and the reverse
    double error = 0, median = 0; ///< of min(1, |distance - exact| / exact) where both meet something; error: mean
    double maps = 0;              ///< per ray
    double exact = 0;             ///< share of ImpostorHit::exact
};

inline Accuracy accuracy(std::span<Hit const> truth, std::span<ImpostorHit const> found)
{
    Accuracy a;
    std::vector<double> errors;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        a.maps += found[k].maps;
        a.exact += found[k].exact;
        bool const is = truth[k].triangle != kNoTriangle, hit = found[k].hit.triangle != kNoTriangle;
        a.lost += is && !hit;
        a.extra += !is && hit;
        a.wrong += is != hit;
        if (!is || !hit) continue;
        double const exact = double(std::max(truth[k].distance, 1e-30f)),
                     off = std::abs(double(found[k].hit.distance) - double(truth[k].distance)) / exact;
        errors.push_back(std::min(off, 1.0));
        a.error += errors.back();
        a.wrong += truth[k].triangle != found[k].hit.triangle && !(off <= 0.02);
    }
    auto const n = double(std::max<std::size_t>(truth.size(), 1));
    for (double* const share : {&a.wrong, &a.lost, &a.extra, &a.maps, &a.exact}) *share /= n;
    a.error /= double(std::max<std::size_t>(errors.size(), 1));
    a.median = errors.empty() ? 0 : gi::median(errors);
    return a;
}

/// What ImpostorRays find, and how.
inline std::vector<ImpostorHit> how_followed(World const& world, Impostors const& impostors,
                                             ImpostorSettings const& settings, std::span<PathQuery const> rays)
{
    ImpostorScene const scene = ImpostorRays(world, impostors).scene();
    std::vector<ImpostorHit> found;
    for (PathQuery const& q : rays) found.push_back(follow(scene, q, settings));
    return found;
}

inline Accuracy accuracy(World const& world, Impostors const& impostors, ImpostorSettings const& settings,
                         ExactVisibility const& visibility, std::span<PathQuery const> rays)
{
    std::vector<Hit> truth(rays.size());
    std::vector<PathQuery> copies(rays.begin(), rays.end());
    ExactPathRays(visibility).nearest(copies, truth);
    return accuracy(truth, how_followed(world, impostors, settings, rays));
}

} // namespace gi::test
