#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/hit_buffers/directions/directions.h"
#include "gi/hit_buffers/query_batch.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/world_bvh.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/shading/warp.h"
#include "viewer/bench/bench_record.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/load_world.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace viewer {
namespace {

using namespace gi;

struct RaysOptions {
    RenderOptions render;
    std::vector<std::string> scenes{"atrium", "cornell"};
    std::string directions = "icosahedron:320", out;
    int resolution = 128, repeats = 7;
};

struct Origin {
    vec3 position, normal; ///< normal: unit length, on the side that was hit
    std::uint32_t triangle;
};

/// Surface points after the camera ray and one diffuse bounce, at which indirect rays start.
std::vector<Origin> find_origins(World const& world, Camera const& camera, ExactVisibility const& exact,
                                 Pcg32& rng)
{
    constexpr int kSize = 512;
    CameraRays const through = camera_rays(camera, kSize, kSize, world.origin);
    std::vector<RayQuery> rays;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) rays.push_back({through.through({float(x) + 0.5f, float(y) + 0.5f})});
    std::vector<Origin> origins;
    for (int bounce = 0; bounce < 2; ++bounce) {
        std::vector<Hit> hits(rays.size());
        exact.nearest(rays, hits);
        origins.clear();
        for (std::size_t k = 0; k < hits.size(); ++k) {
            if (hits[k].triangle == kNoTriangle) continue;
            Surface const& s = world.surfaces[hits[k].triangle];
            vec3 n = glm::normalize(glm::cross(s.edge1, s.edge2));
            if (glm::dot(n, rays[k].ray.direction) > 0) n = -n;
            origins.push_back({s.corner + hits[k].barycentric.x * s.edge1 + hits[k].barycentric.y * s.edge2, n,
                               hits[k].triangle});
        }
        rays.clear();
        for (Origin const& o : origins) {
            float const off = world.surfaces[o.triangle].clearance;
            rays.push_back({{o.position + off * o.normal,
                             Frame::about(o.normal).to_world(square_to_cosine_hemisphere(rng.uniform2()))}});
        }
    }
    return origins;
}

WalkOrigin walk_from(World const& world, Origin const& o, vec3 axis)
{
    Surface const& s = world.surfaces[o.triangle];
    float const cosine = glm::dot(o.normal, axis);
    return {o.position, o.triangle, glm::dot(glm::cross(s.edge1, s.edge2), axis) > 0, cosine > 0,
            std::sqrt(std::max(0.0f, 1 - cosine * cosine)) / std::abs(cosine)};
}

std::size_t trace_single(ExactVisibility const& exact, std::vector<RayQuery> const& rays)
{
    ExactVisibility::Context context(exact);
    std::size_t hits = 0;
    for (RayQuery const& q : rays) {
        RTCRayHit r{};
        r.ray.org_x = q.ray.origin.x;
        r.ray.org_y = q.ray.origin.y;
        r.ray.org_z = q.ray.origin.z;
        r.ray.dir_x = q.ray.direction.x;
        r.ray.dir_y = q.ray.direction.y;
        r.ray.dir_z = q.ray.direction.z;
        r.ray.tfar = RayQuery::kFar;
        r.ray.mask = 0xffffffffu;
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        gi::embree::intersect(exact.scene(), context.rtc, r);
        hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

void measure_scene(RaysOptions const& o, std::string const& scene, BenchTable& table)
{
    Report report;
    RenderOptions options = o.render;
    options.scene = scene;
    World const world = load_world(options, report);
    Camera const camera = choose_camera(world, camera_choice(options)).camera;
    ExactVisibility const exact(world, false, 1);
    WorldView const viewed = view(world);
    WorldBvh<Space::host> const own(viewed, false, ~std::size_t(0));
    TriangleSoup const soup = make_soup(world);
    DirectionSet const set = make_directions(o.directions);
    Pcg32 rng(1, 1);
    std::vector<HitBuffer> buffers;
    double build_s = 0;
    for (dvec3 const axis : set.axes) {
        vec2 const jitter = rng.uniform2();
        RasterGrid const grid =
            make_grid(world.bounds, vec3(axis), std::uint32_t(o.resolution), jitter, 2 * kPi * rng.uniform());
        build_s += seconds_of([&] { buffers.push_back(make_hit_buffer(soup, grid)); });
    }
    AxisPool pool;
    fill_pool(buffers, pool);
    buffers.clear();

    std::vector<Origin> const origins = find_origins(world, camera, exact, rng);
    std::size_t const n = origins.size(), axes = pool.size();
    std::vector<RayQuery> rays;
    for (Origin const& from : origins) {
        float const off = world.surfaces[from.triangle].clearance;
        rays.push_back({{from.position + off * from.normal,
                         Frame::about(from.normal).to_world(square_to_cosine_hemisphere(rng.uniform2()))}});
    }
    // Axes drawn in proportion to the cosine, as paths do: from all, from 16, or one for a whole pass.
    auto const draw = [&](Origin const& from, std::size_t step, std::size_t count) {
        while (true) {
            std::size_t const a = step * (rng.next() % count);
            if (rng.uniform() < std::abs(glm::dot(from.normal, pool.grids[a].axis))) return a;
        }
    };
    constexpr std::size_t kFew = 16;
    QueryBatch random;
    random.resize(n);
    std::vector<QueryBatch> few(kFew);
    std::vector<std::vector<WalkOrigin>> of_few(kFew);
    std::vector<WalkOrigin> of_one;
    std::size_t const step = std::max<std::size_t>(1, axes / kFew), the_one = axes / 4;
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t const a = draw(origins[k], 1, axes);
        random.set(k, walk_from(world, origins[k], pool.grids[a].axis), std::uint32_t(a));
        std::size_t const b = draw(origins[k], step, std::min(kFew, axes));
        of_few[b / step].push_back(walk_from(world, origins[k], pool.grids[b].axis));
        if (rng.uniform() < std::abs(glm::dot(origins[k].normal, pool.grids[the_one].axis)))
            of_one.push_back(walk_from(world, origins[k], pool.grids[the_one].axis));
    }
    auto const fill = [](QueryBatch& batch, std::vector<WalkOrigin> const& from, std::size_t a) {
        batch.resize(from.size());
        for (std::size_t k = 0; k < from.size(); ++k) batch.set(k, from[k], std::uint32_t(a));
    };
    std::size_t const used = std::min(kFew, axes);
    for (std::size_t k = 0; k < used; ++k) fill(few[k], of_few[k], k * step);
    QueryBatch one;
    fill(one, of_one, the_one);

    if (n == 0 || of_one.empty())
        throw InputError("no indirect ray of '" + scene + "' starts anywhere", "the camera sees nothing",
                         "choose another view");
    std::vector<Hit> hits(n);
    std::size_t sink = 0;
    auto const s = measure_interleaved(
        o.repeats,
        {[&] { sink += trace_single(exact, rays); }, [&] { exact.nearest(rays, hits); },
         [&] {
             for (std::size_t k = 0; k < n; ++k)
                 sink += nearest_layer(pool.axis(random.axis[k]), world.surfaces, random.origin(k)).triangle !=
                         kNoLayerHit;
         },
         [&] { nearest_layers(pool, world.surfaces, random); },
         [&] {
             for (std::size_t k = 0; k < used; ++k) nearest_layers(pool, k * step, world.surfaces, few[k]);
         },
         [&] { nearest_layers(pool, the_one, world.surfaces, one); },
         [&] {
             for (std::size_t k = 0; k < n; ++k) hits[k] = own.rays().nearest(viewed, rays[k]);
         }});
    if (sink == 0)
        throw InputError("no ray of '" + scene + "' hits anything", "the camera sees nothing",
                         "choose another view");

    // Errors of the look-ups against exact rays along the same axes:
    // escapes that should hit, and hits that should escape.
    std::vector<RayQuery> same;
    for (std::size_t k = 0; k < n; ++k) {
        vec3 const axis = pool.grids[random.axis[k]].axis;
        float const off = world.surfaces[origins[k].triangle].clearance;
        same.push_back(
            {{origins[k].position + off * origins[k].normal, (random.triangle[k] & kWalkUp) != 0 ? axis : -axis}});
    }
    exact.nearest(same, hits);
    double false_escapes = 0, false_hits = 0;
    for (std::size_t k = 0; k < n; ++k) {
        bool const truth = hits[k].triangle != kNoTriangle, found = random.hit[k] != kNoLayerHit;
        false_escapes += truth && !found;
        false_hits += found && !truth;
    }
    double const each = double(n);
    char const* const names[] = {"Embree, single rays",      "Embree, packets of 16",
                                 "slhb, random axes, plain", "slhb, random axes, vectors",
                                 "slhb, 16 axes, by axis",   "slhb, one axis",
                                 "own BVH, single rays"};
    for (std::size_t k = 0; k < s.size(); ++k) {
        double const count = k == 5 ? double(one.size()) : each;
        std::vector<double> ns, single;
        for (double const v : s[k]) ns.push_back(v / count * 1e9);
        for (double const v : s[0]) single.push_back(v / each * 1e9);
        bool const judged = k == 2 || k == 3;
        table.add({scene, double(world.triangles.size()), std::string(names[k]), count, summarise(ns),
                   1e3 / summarise(ns).median, ratio(single, ns), judged ? Cell(false_escapes / each) : Cell(),
                   judged ? Cell(false_hits / each) : Cell()});
    }
    table.facts.emplace_back(scene + ": hit buffers built",
                             fmt::format("{} axes in {:.3f} s, {:.0f} M triangle-axes/s, {:.1f} MiB", axes,
                                         build_s, double(world.triangles.size()) * double(axes) / build_s * 1e-6,
                                         double(pool.bytes()) / 1048576));
}

int run(RaysOptions const& o)
{
    check_folder(o.out);
    gi::make_folder(o.out);
    tbb::global_control const one_core(tbb::global_control::max_allowed_parallelism, 1);
    BenchTable table = start_table("rays", "Indirect rays: look-ups against ray tracing, one core",
                                   {"scene", "triangles", "query", "queries", "each_ns", "M_per_s",
                                    "Embree_single_over_it", "false_escapes", "false_hits"});
    table.facts = {{"directions", o.directions}, {"hit buffer", std::to_string(o.resolution)}, {"cores", "1"}};
    for (std::string const& scene : o.scenes) {
        measure_scene(o, scene, table);
        write(table, o.out);
    }
    show(table, o.out, o.render.json);
    return 0;
}

} // namespace

void add_bench_rays(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<RaysOptions>();
    CLI::App* const c =
        bench.add_subcommand("rays", "Measure speed and error of look-ups in hit buffers against Embree.");
    c->add_option("--scene", o->scenes, "files or names, comma-separated")
        ->delimiter(',')
        ->capture_default_str()
        ->allow_extra_args(false);
    declare_view_options(*c, o->render);
    c->add_option("--directions", o->directions, "FAMILY:COUNT")->capture_default_str();
    c->add_option("--hit-buffer", o->resolution, "texels on a side")
        ->check(CLI::Range(2, 8192))
        ->capture_default_str();
    c->add_option("--repeats", o->repeats, "rounds in which all are measured in turn; rows hold medians")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for rays.json and rays.csv")->required();
    c->add_flag("--json", o->render.json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench rays --scene cornell --directions icosahedron:80 --hit-buffer 64 --repeats 2 --out rays

Origins are surface points after one diffuse bounce; axes are drawn in proportion to the cosine. false_escapes and
false_hits are shares of look-ups that differ from exact rays along the same axes.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
