// Many unshaded queries along shared directions: how much of the sky, or of the surroundings within a radius, the
// first surfaces of a picture see (cosine-weighted, as vpl_ao, light of a sky and AR's prefiltered light ask), by exact
// rays and by structures that are rasterised anew for every axis. All threads.
//   bench_sky_visibility [--size WxH] [--radius M] [SCENE...]
//       default: 1280x800; the sky; atrium, cornell
//
// ms: all that is needed per picture but a BVH, which is there already. rms: error of the visible share, over every
// 61st pixel, against 2,048 directions each. doubtful: share of the look-ups that an exact ray decides.

#include "gi/core/morton.h"
#include "gi/hit_buffers/query_batch.h"
#include "gi/hit_buffers/shadow_maps/shadow_map.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "tests/bench/first_surfaces.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <numeric>
#include <string>
#include <tbb/parallel_for.h>
#include <vector>

namespace {

using namespace gi;

struct Options {
    int width = 1280, height = 800;
    float radius = RayQuery::kFar;
    std::vector<std::string> scenes;
};

class Queries {
public:
    Queries(World const& world, Options const& o)
        : world_(world), o_(o), cut_outs_(world), exact_(world, plan_scene(world).alpha_tests, 0)
    {
        points_ = first_surfaces(world, exact_, world.cameras.at(0), o.width, o.height);
        soup_ = make_soup(world);
        truth_ = true_shares(world, exact_, points_, o.radius);
    }
    std::size_t points() const { return points_.size(); }

    /// Every point has its own directions.
    std::vector<float> by_own_rays(int directions)
    {
        std::vector<float> share(points_.size());
        each_part(points_.size(), [&](std::size_t first, std::size_t end) {
            std::vector<RayQuery> rays;
            for (std::size_t p = first; p < end; ++p)
                add_own_rays(world_, points_[p], p, directions, 1, o_.radius, rays);
            std::vector<std::uint8_t> blocked(rays.size());
            exact_.occluded(rays, blocked);
            for (std::size_t k = 0; k < rays.size(); ++k)
                share[first + k / std::size_t(directions)] += (1.0f - float(blocked[k])) / float(directions);
        });
        return share;
    }
    /// @param sorted  by the place across the axis
    std::vector<float> by_shared_rays(int directions, bool sorted)
    {
        std::vector<float> share(points_.size());
        std::vector<std::uint32_t> order(points_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::vector<std::uint64_t> keys(points_.size());
        for (vec3 const axis : half_sphere_axes(directions)) {
            if (sorted) {
                RasterGrid const grid = make_grid(world_.bounds, axis, 1024, vec2{0.5f}, 0);
                for (std::size_t p = 0; p < points_.size(); ++p) {
                    vec3 const x = points_[p].position;
                    auto const at = [&](vec3 across, float corner) {
                        return std::uint32_t(std::max(0.0f, (glm::dot(x, across) - corner) / grid.texel));
                    };
                    keys[p] = morton(at(grid.right, grid.corner.x), at(grid.up, grid.corner.y), 0);
                }
                std::ranges::sort(order, {}, [&](std::uint32_t p) { return keys[p]; });
            }
            each_part(points_.size(), [&](std::size_t first, std::size_t end) {
                std::vector<RayQuery> rays;
                for (std::size_t k = first; k < end; ++k) rays.push_back(along(order[k], axis));
                std::vector<std::uint8_t> blocked(rays.size());
                exact_.occluded(rays, blocked);
                for (std::size_t k = first; k < end; ++k)
                    add(share, order[k], axis, directions, blocked[k - first] == 0);
            });
        }
        return share;
    }
    /// @param confirm  exact rays decide what is doubtful
    std::vector<float> by_hit_buffers(int directions, std::uint32_t texels, bool confirm)
    {
        std::vector<float> share(points_.size());
        std::vector<vec3> const all = half_sphere_axes(directions);
        constexpr std::size_t kTogether = 8;
        for (std::size_t first_axis = 0; first_axis < all.size(); first_axis += kTogether) {
            std::size_t const n = std::min(kTogether, all.size() - first_axis);
            std::vector<HitBuffer> buffers(n);
            tbb::parallel_for(std::size_t(0), n, [&](std::size_t a) {
                RasterGrid const grid = make_grid(world_.bounds, all[first_axis + a], texels, vec2{0.4f}, 0.3f);
                BorrowedFragments fragments;
                rasterize(soup_, 0, soup_.count, grid, MacroPath::edge_table, *fragments);
                cut_outs_.remove(*fragments, grid, 0);
                fill_hit_buffer(*fragments, grid, 0, buffers[a]);
            });
            AxisPool pool;
            fill_pool(buffers, pool);
            each_part(points_.size(), [&](std::size_t first, std::size_t end) {
                thread_local QueryBatch batch;
                thread_local std::vector<RayQuery> rays;
                thread_local std::vector<std::uint32_t> asked;
                thread_local std::vector<std::uint8_t> blocked;
                batch.checked = confirm;
                batch.resize(end - first);
                for (std::size_t a = 0; a < n; ++a) {
                    vec3 const axis = all[first_axis + a];
                    for (std::size_t p = first; p < end; ++p)
                        batch.set(p - first, walk_along(world_, points_[p], axis), 0);
                    nearest_layers(pool, a, world_.surfaces, batch);
                    rays.clear();
                    asked.clear();
                    for (std::size_t p = first; p < end; ++p) {
                        std::size_t const k = p - first;
                        if (confirm && batch.doubtful[k] != 0) {
                            rays.push_back(along(std::uint32_t(p), axis));
                            asked.push_back(std::uint32_t(p));
                            continue;
                        }
                        bool free = batch.hit[k] == kNoLayerHit;
                        if (!free && o_.radius < RayQuery::kFar)
                            free = glm::length(batch.found(k).position - points_[p].position) > o_.radius;
                        add(share, p, axis, directions, free);
                    }
                    if (rays.empty()) continue;
                    blocked.resize(rays.size());
                    exact_.occluded(rays, blocked);
                    for (std::size_t k = 0; k < rays.size(); ++k)
                        add(share, asked[k], axis, directions, blocked[k] == 0);
                    doubtful_ += rays.size();
                }
                asked_ += n * (end - first);
            });
        }
        return share;
    }
    /// Shadow maps: first layers alone; only for the sky.
    std::vector<float> by_shadow_maps(int directions, std::uint32_t texels)
    {
        std::vector<float> share(points_.size());
        std::vector<vec3> const all = half_sphere_axes(directions);
        ShadowMapBuilder const builder(world_.bounds, {}, soup_, cut_outs_, texels);
        constexpr std::size_t kTogether = 8;
        for (std::size_t first_axis = 0; first_axis < all.size(); first_axis += kTogether) {
            std::size_t const n = std::min(kTogether, all.size() - first_axis);
            std::vector<ShadowMap> maps(2 * n);
            tbb::parallel_for(std::size_t(0), maps.size(), [&](std::size_t m) {
                ShadowView const from{true, m % 2 == 0 ? all[first_axis + m / 2] : -all[first_axis + m / 2],
                                      vec3{0}};
                builder.start(from, vec2{0.4f}, 0.3f, maps[m]);
                builder.build(from, 0, soup_.count, 0, maps[m]);
            });
            each_part(points_.size(), [&](std::size_t first, std::size_t end) {
                std::vector<RayQuery> rays;
                std::vector<std::pair<std::uint32_t, std::uint32_t>> asked;
                for (std::size_t a = 0; a < n; ++a)
                    for (std::size_t p = first; p < end; ++p) {
                        vec3 const axis = all[first_axis + a];
                        SeenPoint const& at = points_[p];
                        ShadowMap const& map = maps[2 * a + (glm::dot(at.normal, axis) > 0 ? 0 : 1)];
                        LitBy const by = map.lit_by(map.look(at.position, at.normal, vec2{0.5f}), world_.surfaces,
                                                    at.position, at.normal, at.triangle);
                        if (by == LitBy::some) {
                            rays.push_back(along(std::uint32_t(p), axis));
                            asked.emplace_back(std::uint32_t(p), std::uint32_t(first_axis + a));
                        } else {
                            add(share, p, axis, directions, by == LitBy::all);
                        }
                    }
                std::vector<std::uint8_t> blocked(rays.size());
                exact_.occluded(rays, blocked);
                for (std::size_t k = 0; k < rays.size(); ++k)
                    add(share, asked[k].first, all[asked[k].second], directions, blocked[k] == 0);
                doubtful_ += rays.size();
                asked_ += n * (end - first);
            });
        }
        return share;
    }
    double rms(std::vector<float> const& share) const { return rms_error(share, truth_); }
    double take_doubtful()
    {
        double const share = asked_ > 0 ? double(doubtful_) / double(asked_) : 0;
        asked_ = doubtful_ = 0;
        return share;
    }

private:
    RayQuery along(std::uint32_t p, vec3 axis) const { return ray_along(world_, points_[p], axis, o_.radius); }
    void add(std::vector<float>& share, std::size_t p, vec3 axis, int directions, bool free) const
    {
        add_axis(share[p], points_[p], axis, directions, free);
    }

    World const& world_;
    Options const& o_;
    CutOuts cut_outs_;
    ExactVisibility exact_;
    TriangleSoup soup_;
    std::vector<SeenPoint> points_;
    std::vector<float> truth_; ///< of every kJudgedEvery-th point
    std::atomic<std::size_t> asked_ = 0, doubtful_ = 0;
};

void run(Options const& o, std::string const& name)
{
    Report report;
    World const world = build_world(std::make_shared<Scene const>(load_scene(name, report)), std::nullopt, report);
    Queries scene(world, o);
    fmt::print("{}, {} triangles, {} points\n  {:<38}{:>6}{:>10}{:>10}{:>10}\n", name, world.triangles.size(),
               scene.points(), "", "axes", "ms", "rms", "doubtful");
    for (int const n : {16, 64}) {
        auto const measure = [&](char const* tool, std::function<std::vector<float>()> const& work) {
            std::vector<float> share;
            double best = kInf;
            for (int k = 0; k < 2; ++k) {
                scene.take_doubtful();
                auto const begun = std::chrono::steady_clock::now();
                share = work();
                best = std::min(
                    best,
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count());
            }
            fmt::print("  {:<38}{:>6}{:>10.1f}{:>10.4f}{:>10.3f}\n", tool, n, best, scene.rms(share),
                       scene.take_doubtful());
            std::fflush(stdout);
        };
        measure("rays, own directions", [&] { return scene.by_own_rays(n); });
        measure("rays along shared axes", [&] { return scene.by_shared_rays(n, false); });
        measure("rays along shared axes, sorted", [&] { return scene.by_shared_rays(n, true); });
        for (std::uint32_t const texels : {256u, 1024u}) {
            measure(texels == 256 ? "hit buffers, 256" : "hit buffers, 1024",
                    [&] { return scene.by_hit_buffers(n, texels, false); });
            measure("  and rays where doubtful", [&] { return scene.by_hit_buffers(n, texels, true); });
            if (o.radius == RayQuery::kFar)
                measure(texels == 256 ? "shadow maps, 256, and rays" : "shadow maps, 1024, and rays",
                        [&] { return scene.by_shadow_maps(n, texels); });
        }
    }
}

} // namespace

int main(int argc, char** argv)
{
    Options o;
    for (int k = 1; k < argc; ++k) {
        std::string const word = argv[k];
        if (word == "--size" && k + 1 < argc)
            std::sscanf(argv[++k], "%dx%d", &o.width, &o.height);
        else if (word == "--radius" && k + 1 < argc)
            o.radius = std::strtof(argv[++k], nullptr);
        else
            o.scenes.push_back(word);
    }
    if (o.scenes.empty()) o.scenes = {"atrium", "cornell"};
    for (std::string const& name : o.scenes) run(o, name);
}
