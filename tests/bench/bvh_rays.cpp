// The project's BVH beside Embree: building, refitting, incoherent rays (cosine-distributed from points on
// surfaces), single and on one thread, by turns in one process; and how many answers differ.
// Then rays that only ask whether anything is in the way; and what a frame costs with a tree for what moves
// beside that for what stays, and with one tree of everything, built anew.
//   bench_bvh_rays [--rays N] [SCENE...]      default: 400,000 rays; boxes of 1M triangles, atrium, cornell

#include "gi/bvh/build_kernels.h"
#include "gi/core/quantile.h"
#include "gi/core/report.h"
#include "gi/core/rng.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/world_bvh.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/shading/warp.h"
#include "tests/bench/device/starts.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace {

using namespace gi;

/// The own BVH in the form of ExactVisibility.
class OwnBvh {
public:
    OwnBvh(World const& world, std::size_t first_moving) : world_(view(world)), bvh_(world_, false, first_moving)
    {
    }
    void moved(World const& world)
    {
        world_ = view(world);
        bvh_.moved(world_);
    }
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits) const
    {
        KernelRays const rays = bvh_.rays();
        for (std::size_t i = 0; i < queries.size(); ++i) hits[i] = rays.nearest(world_, queries[i]);
    }
    std::size_t occluded(std::span<RayQuery const> queries) const
    {
        KernelRays const rays = bvh_.rays();
        return std::size_t(
            std::ranges::count_if(queries, [&](RayQuery const& q) { return rays.occluded(world_, q); }));
    }
    HostBvh const& moving() const { return bvh_.moving(); }

private:
    WorldView world_;
    WorldBvh<Space::host> bvh_;
};

/// By the surface area heuristic: the number of nodes and leaves (as kNodeCost and kLeafCost weigh them) that a
/// ray through the box of all triangles is expected to meet.
double traversal_cost(HostBvh const& bvh)
{
    double sum = 0;
    if (bvh.nodes.size() == 0) return 0;
    View<Box const> const boxes = bvh.boxes.view();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        WideNode const& node = bvh.nodes.view()[i];
        sum += double(kNodeCost) * double(boxes[i].half_area());
        for (std::uint32_t k = 0; k < node.leaves; ++k) {
            if (node.high[0][k] < node.low[0][k]) continue;
            Box box;
            for (int axis = 0; axis < 3; ++axis) {
                box.low[axis] = float(node.low[axis][k]) * node.step(axis);
                box.high[axis] = float(node.high[axis][k]) * node.step(axis);
            }
            sum += double(kLeafCost) * double(box.half_area());
        }
    }
    double const all = double(boxes[0].half_area());
    return all > 0 ? sum / all : 0;
}

template <class Work>
double seconds(Work const& work)
{
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<RayQuery> incoherent_rays(World const& world, std::size_t n)
{
    Pcg32 rng(3, 2);
    std::vector<RayQuery> rays;
    for (bench::Start const& s : bench::anywhere(world, n)) {
        vec3 const d = Frame::about(s.normal).to_world(square_to_cosine_hemisphere(rng.uniform2()));
        rays.push_back({.ray = {s.position + world.surfaces[s.triangle].clearance * s.normal, d},
                        .seed = std::uint32_t(rays.size())});
    }
    return rays;
}

void by_embree(ExactVisibility const& exact, std::span<RayQuery const> queries, std::vector<Hit>& hits)
{
    ExactVisibility::Context context(exact);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        RayQuery const& q = queries[i];
        RTCRayHit r;
        r.ray.org_x = q.ray.origin.x;
        r.ray.org_y = q.ray.origin.y;
        r.ray.org_z = q.ray.origin.z;
        r.ray.tnear = 0;
        r.ray.dir_x = q.ray.direction.x;
        r.ray.dir_y = q.ray.direction.y;
        r.ray.dir_z = q.ray.direction.z;
        r.ray.time = 0;
        r.ray.tfar = q.reach;
        r.ray.mask = 0xffffffffu;
        r.ray.id = q.seed;
        r.ray.flags = 0;
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::intersect(exact.scene(), context.rtc, r);
        hits[i] =
            r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? Hit{} : Hit{r.hit.primID, {r.hit.u, r.hit.v}, r.ray.tfar};
    }
}

std::size_t occluded_by_embree(ExactVisibility const& exact, std::span<RayQuery const> queries)
{
    ExactVisibility::Context context(exact);
    std::size_t n = 0;
    for (RayQuery const& q : queries) {
        RTCRay r{};
        r.org_x = q.ray.origin.x;
        r.org_y = q.ray.origin.y;
        r.org_z = q.ray.origin.z;
        r.dir_x = q.ray.direction.x;
        r.dir_y = q.ray.direction.y;
        r.dir_z = q.ray.direction.z;
        r.tfar = q.reach;
        r.mask = 0xffffffffu;
        embree::occluded(exact.scene(), context.rtc, r);
        n += r.tfar < 0 ? 1 : 0;
    }
    return n;
}

/// A frame: updating for what moved, and rays.
void measure_frame(World const& world, std::span<RayQuery const> rays)
{
    if (world.static_triangles == world.triangles.size()) return;
    OwnBvh two(world, world.static_triangles);
    std::vector<Hit> hits(rays.size());
    std::vector<double> refit_s, two_s, build_s, one_s;
    for (int round = 0; round < 5; ++round) {
        refit_s.push_back(seconds([&] { two.moved(world); }));
        two_s.push_back(seconds([&] { two.nearest(rays, hits); }));
        std::optional<OwnBvh> one;
        build_s.push_back(seconds([&] { one.emplace(world, ~std::size_t(0)); }));
        one_s.push_back(seconds([&] { one->nearest(rays, hits); }));
    }
    fmt::print(
        "  a frame of {} rays, {} of {} triangles move: two trees {:.4f} + {:.3f} s, one tree {:.4f} + {:.3f} s\n",
        rays.size(), world.triangles.size() - world.static_triangles, world.triangles.size(), median(refit_s),
        median(two_s), median(build_s), median(one_s));
}

void measure(std::string const& name, Scene scene, std::size_t kRays)
{
    constexpr int kRounds = 7;
    Report report;
    World const world = build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
    std::optional<ExactVisibility> exact;
    std::optional<OwnBvh> own;
    std::vector<double> embree_build_s, build_s, refit_s, embree_s, packets_s, own_s, ratio;
    for (int round = 0; round < 3; ++round) {
        embree_build_s.push_back(seconds([&] { exact.emplace(world, false, 0); }));
        build_s.push_back(seconds([&] { own.emplace(world, 0); })); // all in the tree that can be refitted
        refit_s.push_back(seconds([&] { own->moved(world); }));
    }
    std::vector<RayQuery> const rays = incoherent_rays(world, kRays);
    std::vector<Hit> a(kRays), b(kRays);
    for (int round = 0; round < kRounds; ++round) {
        embree_s.push_back(seconds([&] { by_embree(*exact, rays, a); }));
        own_s.push_back(seconds([&] { own->nearest(rays, b); }));
        ratio.push_back(embree_s.back() / own_s.back());
    }
    std::size_t different = 0, unexplained = 0;
    for (std::size_t i = 0; i < kRays; ++i) {
        if (a[i].triangle == b[i].triangle) continue;
        ++different;
        // Other triangles at the same distance, within the rounding of coordinates, lie in one place.
        float const rounding = 1e-5f * std::max(a[i].distance, b[i].distance) + 1e-6f * world.bounds.radius();
        if (!(std::abs(a[i].distance - b[i].distance) <= rounding) && ++unexplained <= 3)
            fmt::print("  ray {}: Embree {} at {}, own {} at {}\n", i, a[i].triangle, a[i].distance, b[i].triangle,
                       b[i].distance);
    }
    auto const [low, high] = std::minmax_element(ratio.begin(), ratio.end());
    std::vector<RayQuery> shadow = rays; // to half the scene's radius
    for (RayQuery& q : shadow) q.reach = 0.5f * world.bounds.radius();
    std::vector<double> any_embree_s, any_own_s;
    std::size_t embree_blocked = 0, own_blocked = 0;
    for (int round = 0; round < 3; ++round) {
        any_embree_s.push_back(seconds([&] { embree_blocked = occluded_by_embree(*exact, shadow); }));
        any_own_s.push_back(seconds([&] { own_blocked = own->occluded(shadow); }));
    }
    HostBvh const& tree = own->moving();
    fmt::print(
        "{:<24} {:>9} {:>8.3f} {:>8.3f} {:>8.3f} {:>7.2f} {:>7.2f} {:>6.3f} [{:.3f}, {:.3f}] {:>6} {:>6} {:>7.1f} "
        "{:>5} {:>6.1f}\n",
        name, world.triangles.size(), median(embree_build_s), median(build_s), median(refit_s),
        double(kRays) / median(embree_s) * 1e-6, double(kRays) / median(own_s) * 1e-6, median(ratio), *low, *high,
        different, unexplained, traversal_cost(tree), tree.level.size() - 1,
        double(tree.bytes()) / double(world.triangles.size()));
    fmt::print("  any hit: Embree {:.2f}, own {:.2f} Mray/s, ratio {:.3f}; blocked {} and {} of {}\n",
               double(kRays) / median(any_embree_s) * 1e-6, double(kRays) / median(any_own_s) * 1e-6,
               median(any_embree_s) / median(any_own_s), embree_blocked, own_blocked, kRays);
    measure_frame(world, rays);
}

} // namespace

int main(int argc, char** argv)
{
    fmt::print("{:<24} {:>9} {:^26} {:^15} {:>6} {:^14} {:^13} {:>7} {:>5} {:>6}\n", "", "",
               "build Embree, own, refit", "Mray/s", "own /", "", "differences", "", "", "B/tri-");
    fmt::print("{:<24} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>6} {:^14} {:>6} {:>6} {:>7} {:>5} {:>6}\n", "scene",
               "triangles", "s", "s", "s", "Embree", "own", "Embree", "[min, max]", "all", "unexpl", "SAH",
               "depth", "angle");
    int first = 1;
    std::size_t rays = 400'000;
    if (argc > 2 && std::string(argv[1]) == "--rays") {
        rays = std::stoul(argv[2]);
        first = 3;
    }
    if (argc == first) {
        measure("boxes, 1M triangles", generate_boxes(1'000'000, 0), rays);
        measure("atrium", generate_atrium({}), rays);
        measure("cornell", generate_cornell(), rays);
    }
    for (int i = first; i < argc; ++i) {
        Report report;
        measure(argv[i], load_scene(argv[i], report), rays);
    }
}
