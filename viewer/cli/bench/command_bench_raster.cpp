#include "gi/core/durable_file.h"
#include "gi/core/rng.h"
#include "gi/hit_buffers/hit_buffer.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/generate/generate.h"
#include "viewer/bench/bench_record.h"
#include "viewer/cli/commands.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <tbb/parallel_for.h>

namespace viewer {
namespace {

using namespace gi;

struct RasterOptions {
    int meshes = 10'000, repeats = 5;
    double samples = 1e7;
    std::uint32_t triangles = 1'000'000; ///< of the largest model
    std::string out;
    bool json = false;
};

World world_of(Scene scene)
{
    Report report;
    return build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
}

vec3 random_axis(Pcg32& rng)
{
    float const z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

RasterGrid random_grid(World const& world, Pcg32& rng, std::uint32_t resolution)
{
    vec3 const axis = random_axis(rng);
    vec2 const jitter = rng.uniform2();
    return make_grid(world.bounds, axis, resolution, jitter, 2 * kPi * rng.uniform());
}

/// Random closed mesh: a stretched lattice on a sphere, with vertices displaced radially unless convex.
Scene random_closed_mesh(Pcg32& rng, bool convex)
{
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    std::uint32_t const segments = 3 + rng.next() % 30, rings = 2 + rng.next() % 15;
    vec3 const stretch = vec3{0.1f} + vec3{rng.uniform(), rng.uniform(), rng.uniform()};
    float const roughness = convex ? 0.0f : 1.5f;
    auto const vertex = [&](float theta, float phi) {
        vec3 const p{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
        mesh.positions.push_back(stretch * p * (1 + roughness * (rng.uniform() - 0.5f)));
    };
    vertex(0, 0);
    for (std::uint32_t r = 1; r < rings; ++r)
        for (std::uint32_t s = 0; s < segments; ++s)
            vertex(kPi * float(r) / float(rings), 2 * kPi * float(s) / float(segments));
    vertex(kPi, 0);
    auto const at = [&](std::uint32_t r, std::uint32_t s) { return 1 + (r - 1) * segments + s % segments; };
    auto const south = std::uint32_t(mesh.positions.size() - 1);
    for (std::uint32_t s = 0; s < segments; ++s) {
        mesh.triangles.push_back({0, at(1, s + 1), at(1, s)});
        mesh.triangles.push_back({south, at(rings - 1, s), at(rings - 1, s + 1)});
        for (std::uint32_t r = 1; r + 1 < rings; ++r) {
            mesh.triangles.push_back({at(r, s), at(r, s + 1), at(r + 1, s)});
            mesh.triangles.push_back({at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)});
        }
    }
    scene.nodes.emplace_back().meshes = {0};
    return scene;
}

/// Counts texels with different numbers of entering and leaving layers, and texels of convex
/// meshes with neither 0 nor 2 layers.
void check_watertight(RasterOptions const& o, BenchTable& table)
{
    Pcg32 rng(2026, 1);
    double texels = 0, layers = 0, unbalanced = 0, not_two = 0;
    for (int k = 0; k < o.meshes; ++k) {
        bool const convex = k % 2 == 0;
        World const world = world_of(random_closed_mesh(rng, convex));
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_grid(world, rng, 8u << (k % 5));
        HitBuffer const b = make_hit_buffer(soup, grid, MacroPath(k % 3));
        for (std::size_t t = 0; t < grid.texels(); ++t) {
            int sum = 0;
            std::uint32_t const n = b.offset[t + 1] - b.offset[t];
            for (std::uint32_t i = b.offset[t]; i < b.offset[t + 1]; ++i)
                sum += (b.layers[i].primitive & kAlongAxis) != 0 ? 1 : -1;
            texels += n > 0;
            layers += n;
            unbalanced += sum != 0;
            not_two += convex && n != 0 && n != 2;
        }
    }
    table.add({fmt::format("watertight: {} random closed meshes", o.meshes), std::string("texels covered"), texels,
               std::string("layers"), layers});
    table.add({std::string("  entering layers = leaving layers"), std::string("texels where not"), unbalanced,
               std::string(), Cell()});
    table.add({std::string("  convex: no layer or two"), std::string("texels where not"), not_two,
               std::string("(holes and doubles)"), Cell()});
}

/// Compares the layers of every texel with rays through its centre.
void check_against_embree(char const* name, World const& world, double wanted, BenchTable& table)
{
    ExactVisibility const exact(world, false, 0);
    TriangleSoup const soup = make_soup(world);
    Pcg32 rng(2026, 2);
    double samples = 0, other = 0, near_edge = 0, depth_error = 0, worst = 0, edge_on = 0, twins = 0;
    while (samples < wanted) {
        RasterGrid const grid = random_grid(world, rng, 512);
        HitBuffer const b = make_hit_buffer(soup, grid);
        float const start = glm::dot(world.bounds.center(), grid.axis) - 2 * world.bounds.radius();
        std::vector<RayQuery> rays(grid.texels());
        for (std::size_t t = 0; t < grid.texels(); ++t)
            rays[t] = {
                {grid.point(std::uint32_t(t) % grid.width, std::uint32_t(t) / grid.width, start), grid.axis}};
        std::vector<Hit> hits(rays.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), 4096), [&](auto const& r) {
            exact.nearest(std::span(rays).subspan(r.begin(), r.size()),
                          std::span(hits).subspan(r.begin(), r.size()));
        });
        for (std::size_t t = 0; t < grid.texels() && samples < wanted; ++t) {
            bool const none = b.offset[t] == b.offset[t + 1];
            std::uint32_t const found = none ? kNoTriangle : b.layers[b.offset[t]].primitive & kPrimitiveMask;
            ++samples;
            if (found == hits[t].triangle) {
                if (none) continue;
                double const error =
                    std::abs(double(b.layers[b.offset[t]].depth) - double(start) - double(hits[t].distance)) /
                    double(world.bounds.radius());
                Surface const& s = world.surfaces[found];
                vec3 const n = glm::normalize(glm::cross(s.edge1, s.edge2));
                if (std::abs(glm::dot(n, grid.axis)) < 1e-2f) {
                    ++edge_on;
                    continue;
                }
                depth_error += error;
                worst = std::max(worst, error);
                continue;
            }
            ++other;
            // Coplanar duplicates or touching surfaces: the same depth, but another triangle.
            double const depth = none ? 1e30 : double(b.layers[b.offset[t]].depth) - double(start);
            if (hits[t].triangle != kNoTriangle &&
                std::abs(depth - double(hits[t].distance)) < 1e-5 * double(world.bounds.radius())) {
                ++twins;
                continue;
            }
            // Is the sample within rounding of an edge? Then a ray 0.01 texel beside it finds the same triangle.
            bool near = false;
            for (int k = 0; k < 64 && !near; ++k) {
                float const angle = 2 * kPi * float(k) / 64, reach = k % 2 == 0 ? 1e-2f : 1e-3f;
                RayQuery beside = rays[t];
                beside.ray.origin +=
                    reach * grid.texel * (std::cos(angle) * grid.right + std::sin(angle) * grid.up);
                Hit h;
                exact.nearest(std::span(&beside, 1), std::span(&h, 1));
                near = h.triangle == found;
            }
            near_edge += near;
        }
    }
    table.add({fmt::format("first layer against Embree: {}", name), std::string("samples"), samples,
               std::string("other triangle"), other});
    table.add({std::string("  of these at the same depth (twins, contacts, shared edges)"), std::string("samples"),
               twins, std::string(), Cell()});
    table.add({std::string("  of the others, the same triangle within 0.01 texel"), std::string("samples"),
               near_edge, std::string("unexplained"), other - twins - near_edge});
    table.add({std::string("  depth where triangles agree, of the scene's radius"), std::string("mean error"),
               depth_error / std::max(1.0, samples - other - edge_on), std::string("largest"), worst});
}

void measure_builds(RasterOptions const& o, BenchTable& table)
{
    for (std::uint32_t const triangles : {o.triangles / 64, o.triangles / 16, o.triangles / 4, o.triangles}) {
        World const world = world_of(generate_sphere(triangles, 0));
        TriangleSoup const soup = make_soup(world);
        for (std::uint32_t const resolution : {128u, 512u}) {
            Pcg32 rng(3, 3);
            std::vector<double> rates;
            for (int k = 0; k < 4 * o.repeats; ++k) {
                RasterGrid const grid = random_grid(world, rng, resolution);
                rates.push_back(double(soup.count) / seconds_of([&] { make_hit_buffer(soup, grid); }) * 1e-6);
            }
            table.add({fmt::format("build, room with {} triangles, hit buffer {}", soup.count, resolution),
                       std::string("M triangle-axes/s/core"), summarise(rates), std::string(), Cell()});
        }
    }
    World const world = world_of(generate_sphere(o.triangles, 0));
    TriangleSoup const soup = make_soup(world);
    for (int const axes : {1, 4, 16, 64}) {
        Pcg32 rng(3, 4);
        std::vector<double> ms;
        for (int r = 0; r < o.repeats; ++r)
            ms.push_back(1e3 / axes * seconds_of([&] {
                             for (int a = 0; a < axes; ++a) make_hit_buffer(soup, random_grid(world, rng, 128));
                         }));
        table.add({fmt::format("build, {} triangles, {} axes", soup.count, axes), std::string("ms per axis"),
                   summarise(ms), std::string(), Cell()});
    }
    auto const bvh = measure(std::max(1, o.repeats / 2), [&] { ExactVisibility const exact(world, false, 1); });
    table.add({fmt::format("peer: Embree " RTC_VERSION_STRING ", robust, default build, {} triangles", soup.count),
               std::string("s on one core"), bvh, std::string(), Cell()});
}

/// Compares the three ways to subdivide large triangles.
void measure_macro(RasterOptions const& o, BenchTable& table)
{
    for (double const side : {4.0, 8.0, 16.0, 64.0, 256.0}) {
        // Triangles with sides of that many texels, at random in a square of 512 texels.
        TriangleSoup soup;
        soup.count = 4096;
        Pcg32 rng(4, 4);
        for (auto& c : soup.corner) c.assign(soup.count, 0.0f);
        Bounds bounds{vec3{0}, vec3{512, 512, 1}};
        for (std::size_t t = 0; t < soup.count; ++t) {
            vec2 const at = (512 - float(side)) * rng.uniform2();
            for (std::size_t k = 0; k < 3; ++k) {
                vec2 const p = at + float(side) * rng.uniform2();
                soup.corner[3 * k][t] = p.x;
                soup.corner[3 * k + 1][t] = p.y;
                soup.corner[3 * k + 2][t] = rng.uniform();
            }
        }
        RasterGrid const grid = make_grid(bounds, vec3{0, 0, 1}, 513, {0.5f, 0.5f}, 0);
        Fragments f;
        std::vector<std::function<void()>> ways;
        for (MacroPath const path : {MacroPath::edge_table, MacroPath::linear_blocks, MacroPath::square_blocks})
            ways.push_back([&, path] {
                f.count = 0;
                rasterize(soup, 0, soup.count, grid, path, f);
            });
        auto const s = measure_interleaved(o.repeats, ways);
        char const* const names[] = {"edge table", "linear blocks", "4x4 blocks"};
        for (std::size_t k = 0; k < s.size(); ++k) {
            std::vector<double> ns;
            for (double const v : s[k]) ns.push_back(v / double(soup.count) * 1e9);
            table.add({fmt::format("triangles of {} texels: {}", side, names[k]), std::string("ns per triangle"),
                       summarise(ns), std::string("over edge table"), ratio(s[k], s[0])});
        }
    }
}

int run(RasterOptions const& o)
{
    check_folder(o.out);
    gi::make_folder(o.out);
    BenchTable table = start_table("raster", "The deep rasteriser: correctness and speed",
                                   {"what", "unit", "value", "also", "second"});
    check_watertight(o, table);
    check_against_embree("room with a displaced sphere", world_of(generate_sphere(o.triangles, 0)), o.samples / 2,
                         table);
    check_against_embree("atrium", world_of(generate_atrium({})), o.samples / 2, table);
    measure_builds(o, table);
    measure_macro(o, table);
    write(table, o.out);
    show(table, o.out, o.json);
    return 0;
}

} // namespace

void add_bench_raster(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<RasterOptions>();
    CLI::App* const c =
        bench.add_subcommand("raster", "Test and time the deep rasteriser: watertight, equal to Embree, fast.");
    c->add_option("--meshes", o->meshes, "number of random closed meshes to check")
        ->check(CLI::Range(1, 10'000'000))
        ->capture_default_str();
    c->add_option("--samples", o->samples, "number of texel centres to check against Embree")
        ->check(CLI::Range(1.0, 1e9))
        ->capture_default_str();
    c->add_option("--triangles", o->triangles, "triangles of the largest model")
        ->check(CLI::Range(1000u, 100'000'000u))
        ->capture_default_str();
    c->add_option("--repeats", o->repeats, "measurements of each time; rows hold medians")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for raster.json and raster.csv")->required();
    c->add_flag("--json", o->json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench raster --meshes 200 --samples 20000 --triangles 20000 --repeats 1 --out raster)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
