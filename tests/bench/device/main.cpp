// The kernels of rays, hit buffers and look-ups on a CUDA device: speed beside what the machine can do, and errors
// beside Embree's answers. Look-ups go along axes; rays of the same starts and directions tell what they miss.
// Starts are first surfaces in the order of pixels, or random points of all surfaces.
//   bench_device [--host] [--rays N] [--dump FOLDER] [SCENE...]
//     --host   kernels run on the CPU (to test this program)
//     --dump   writes triangles, rays and answers for other programs, one file per scene and kind of starts
//   default: 4,194,304 rays; boxes of 1M triangles, atrium, cornell

#include "gi/bvh/trace_rays.h"
#include "gi/core/quantile.h"
#include "gi/core/report.h"
#include "gi/hit_buffers/directions/directions.h"
#include "gi/hit_buffers/build_hit_buffer.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/world_bvh.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/model/world_on.h"
#include "tests/bench/device/ceilings.h"
#include "tests/bench/device/starts.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fstream>

namespace gi::bench {
namespace {

struct Options {
    std::size_t rays = std::size_t(1) << 22;
    std::string dump; ///< folder; empty = none
};

template <class Work>
double seconds(Space space, Work const& work)
{
    finish(space);
    auto const start = std::chrono::steady_clock::now();
    work();
    finish(space);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Median time of a launch, which ends when the device is done.
template <class Work>
double time_of(Space space, Work const& work)
{
    int const warm_up = space == Space::device ? 3 : 0, repeats = space == Space::device ? 21 : 3;
    for (int k = 0; k < warm_up; ++k) work();
    std::vector<double> s;
    for (int k = 0; k < repeats; ++k) s.push_back(seconds(space, work));
    return median(s);
}

template <Space S>
void measure_ceilings()
{
    std::size_t const words = S == Space::device ? std::size_t(1) << 27 : std::size_t(1) << 22,
                      reads = S == Space::device ? std::size_t(1) << 24 : std::size_t(1) << 18;
    Buffer<Words, S> from(words), to(words);
    fill_bytes(S, from.view().data, 0x5a, words * sizeof(Words));
    double const copy_s = time_of(S, [&] {
        launch(S, "copy words", words, CopyWords{std::as_const(from).view(), to.view()});
    });
    Buffer<std::uint32_t, S> sums(reads);
    double const reads_s = time_of(S, [&] {
        launch(S, "read anywhere", reads, ReadAnywhere{std::as_const(from).view(), sums.view()});
    });
    double const nothing_s = time_of(S, [&] {
        launch(S, "copy words", 1, CopyWords{std::as_const(from).view(), to.view()});
    });
    fmt::print(
        "ceilings: copy {:.0f} GB/s read and written; {:.2f} G records of 32 B a second in random order from "
        "{:.1f} GB; {:.1f} us for a launch\n",
        2e-9 * double(words * sizeof(Words)) / copy_s, 1e-9 * double(reads) * ReadAnywhere::kReads / reads_s,
        1e-9 * double(words * sizeof(Words)), 1e6 * nothing_s);
}

/// One ray and one look-up per start, along an axis with a chance in proportion to its cosine.
struct Asked {
    std::vector<BvhQuery> rays;
    std::vector<float> x, y, z, slope;
    std::vector<std::uint32_t> triangle, axis;
};

Asked ask(World const& world, std::span<Start const> starts, DirectionSet const& directions)
{
    Asked out;
    Pcg32 rng(3, 4);
    for (Start const& s : starts) {
        std::uint32_t a;
        float cosine;
        do {
            a = rng.next() % std::uint32_t(directions.axes.size());
            cosine = glm::dot(vec3(directions.axes[a]), s.normal);
        } while (rng.uniform() > std::abs(cosine));
        Surface const& surface = world.surfaces[s.triangle];
        bool const up = cosine > 0, along = glm::dot(normal_of(surface), vec3(directions.axes[a])) > 0;
        vec3 const direction = up ? vec3(directions.axes[a]) : -vec3(directions.axes[a]);
        out.rays.push_back({{s.position + surface.clearance * s.normal, direction}, 0, RayQuery::kFar});
        out.x.push_back(s.position.x);
        out.y.push_back(s.position.y);
        out.z.push_back(s.position.z);
        float const c = std::max(std::abs(cosine), 1e-6f);
        out.slope.push_back(std::sqrt(std::max(0.0f, 1 - c * c)) / c);
        out.triangle.push_back(s.triangle | (along ? kAlongAxis : 0) | (up ? kWalkUp : 0));
        out.axis.push_back(a);
    }
    return out;
}

/// Embree's answers, by all threads.
struct Truth {
    std::vector<Hit> nearest;
    std::vector<std::uint8_t> blocked;
    double nearest_s, any_s;
};

Truth by_embree(ExactVisibility const& exact, Asked const& asked, float any_reach)
{
    Truth t;
    std::size_t const n = asked.rays.size();
    std::vector<RayQuery> far(n), near(n);
    for (std::size_t i = 0; i < n; ++i) {
        far[i] = {.ray = asked.rays[i].ray};
        near[i] = {.ray = asked.rays[i].ray, .reach = any_reach};
    }
    t.nearest.resize(n);
    t.blocked.resize(n);
    constexpr std::size_t kTogether = 4096;
    auto const in_parts = [&](auto const& work) {
        tbb::parallel_for(std::size_t(0), (n + kTogether - 1) / kTogether, [&](std::size_t part) {
            std::size_t const first = part * kTogether;
            work(first, std::min(kTogether, n - first));
        });
    };
    auto const nearest = [&] {
        in_parts([&](std::size_t first, std::size_t count) {
            exact.nearest(std::span(far).subspan(first, count), std::span(t.nearest).subspan(first, count));
        });
    };
    nearest();
    t.nearest_s = seconds(Space::host, nearest);
    t.any_s = seconds(Space::host, [&] {
        in_parts([&](std::size_t first, std::size_t count) {
            exact.occluded(std::span(near).subspan(first, count), std::span(t.blocked).subspan(first, count));
        });
    });
    return t;
}

void dump(std::string const& file, World const& world, Asked const& asked, Truth const& truth, float any_reach)
{
    std::ofstream out(file, std::ios::binary);
    auto const write = [&](auto const& v) { out.write(reinterpret_cast<char const*>(&v), sizeof(v)); };
    out.write("LWRAYS1", 8);
    write(std::uint64_t(world.triangles.size()));
    write(std::uint64_t(asked.rays.size()));
    for (uvec3 const& t : world.triangles)
        for (int k = 0; k < 3; ++k) write(world.positions[t[k]]);
    for (BvhQuery const& q : asked.rays) {
        write(q.ray.origin);
        write(q.ray.direction);
        write(q.start);
        write(q.reach);
    }
    for (Hit const& h : truth.nearest) write(h.triangle == kNoTriangle ? kInf : h.distance);
    for (std::uint8_t const b : truth.blocked) write(b);
    for (std::size_t i = 0; i < asked.rays.size(); ++i) write(any_reach);
    out.close();
    if (!out) throw std::runtime_error(file + " could not be written");
}

/// Rows of one scene.
template <Space S>
class SceneBench {
public:
    SceneBench(std::string const& name, World const& world, Options const& options)
        : name_(name),
          world_(world),
          options_(options),
          there_(world),
          soup_(make_soup(world)),
          soup_there_(soup_),
          exact_(world, false, 0)
    {
    }

    void measure()
    {
        fmt::print("{}: {} triangles\n", name_, world_.triangles.size());
        measure_bvh();
        measure_hit_buffers();
        if (!world_.cameras.empty()) measure_starts("pixels", first_surfaces(world_, exact_, options_.rays));
        measure_starts("random", anywhere(world_, options_.rays));
    }

private:
    static constexpr char const* kDirections = "fibonacci:128"; // 64 axes
    static constexpr std::uint32_t kResolution = 512;

    void measure_bvh()
    {
        auto const build = [&] { bvh_.emplace(there_.view(), false, 0); }; // all in the tree that can be refitted
        build();
        double const build_s = seconds(S, build), refit_s = time_of(S, [&] { bvh_->moved(there_.view()); });
        Bvh<S> const& tree = bvh_->moving();
        fmt::print("  BVH: build {:.2f} ms, refit {:.3f} ms, {:.1f} MiB, depth {}\n", 1e3 * build_s, 1e3 * refit_s,
                   double(tree.bytes()) / 0x1p20, tree.level.size() - 1);
    }

    void measure_hit_buffers()
    {
        std::vector<double> s;
        std::size_t layers = 0, texels = 0;
        for (std::size_t a = 0; a < directions_.axes.size(); ++a) {
            RasterGrid const grid =
                make_grid(world_.bounds, vec3(directions_.axes[a]), kResolution, {0.3f, 0.6f}, float(a));
            HitBufferOn<S> b;
            s.push_back(seconds(S, [&] { b = build_hit_buffer<S>(soup_there_.view(), grid); }));
            layers += b.layers.size();
            texels += grid.texels();
            buffers_.push_back(std::move(b));
        }
        // The fewest bytes: corners read once, layers written once, offsets written once.
        double const bytes =
            (36.0 * double(soup_.count) * double(s.size()) + 8.0 * double(layers) + 4.0 * double(texels)) /
            double(s.size());
        fmt::print(
            "  hit buffer of {}^2: build {:.3f} ms (median of {}), {:.1f} layers a texel, {:.0f} M layers/s, "
            "{:.0f} GB/s of the fewest bytes\n",
            kResolution, 1e3 * median(s), s.size(), double(layers) / double(texels),
            1e-6 * double(layers) / double(s.size()) / median(s), 1e-9 * bytes / median(s));
    }

    void measure_starts(std::string const& kind, std::vector<Start> const& starts)
    {
        Asked const asked = ask(world_, starts, directions_);
        float const any_reach = 0.5f * world_.bounds.radius();
        Truth const truth = by_embree(exact_, asked, any_reach);
        if (!options_.dump.empty())
            dump(options_.dump + "/" + name_ + "-" + kind, world_, asked, truth, any_reach);
        measure_rays(kind, asked, truth, any_reach);
        measure_look_ups(kind, asked, truth);
    }

    bool is_far(Hit const& truth, bool found, float distance, float allowed) const
    {
        if (truth.triangle == kNoTriangle || !found)
            return (truth.triangle != kNoTriangle) != found ? true : false;
        return !(std::abs(truth.distance - distance) <= allowed);
    }

    void measure_rays(std::string const& kind, Asked const& asked, Truth const& truth, float any_reach)
    {
        std::size_t const n = asked.rays.size();
        std::vector<BvhQuery> near = asked.rays;
        for (BvhQuery& q : near) q.reach = any_reach;
        Buffer<BvhQuery, S> const far_there = upload<S>(asked.rays), near_there = upload<S>(near);
        Buffer<BvhHit, S> hits(n), any(n);
        fill_bytes(S, hits.view().data, 0xee, n * sizeof(BvhHit));
        fill_bytes(S, any.view().data, 0xee, n * sizeof(BvhHit));
        BvhView const still = bvh_->still().view(), moving = bvh_->moving().view();
        double const nearest_s = time_of(S, [&] {
            launch(S, "nearest", n, TraceRays<false>{far_there.view(), {still, moving}, hits.view()});
        });
        double const any_s = time_of(S, [&] {
            launch(S, "any", n, TraceRays<true>{near_there.view(), {still, moving}, any.view()});
        });
        std::size_t wrong = 0, any_wrong = 0;
        std::vector<BvhHit> const found = download(hits), some = download(any);
        for (std::size_t i = 0; i < n; ++i) {
            float const rounding = 1e-5f * found[i].distance + 1e-6f * world_.bounds.radius();
            wrong += is_far(truth.nearest[i], found[i].triangle != kNoBvhTriangle, found[i].distance, rounding);
            any_wrong += (some[i].triangle != kNoBvhTriangle) != (truth.blocked[i] != 0);
        }
        fmt::print("  {:<6} rays: nearest {:.0f} Mray/s, any {:.0f}; Embree, all threads {:.1f} and {:.1f}; other "
                   "answers {} and {} of {}\n",
                   kind, 1e-6 * double(n) / nearest_s, 1e-6 * double(n) / any_s,
                   1e-6 * double(n) / truth.nearest_s, 1e-6 * double(n) / truth.any_s, wrong, any_wrong, n);
        nearest_s_ = nearest_s;
    }

    void measure_look_ups(std::string const& kind, Asked const& asked, Truth const& truth)
    {
        std::size_t const n = asked.rays.size();
        std::vector<AxisView> axes;
        for (HitBufferOn<S> const& b : buffers_) axes.push_back({{b.view(), {}}});
        Buffer<AxisView, S> const axes_there = upload<S>(axes);
        Buffer<float, S> const x = upload<S>(asked.x), y = upload<S>(asked.y), z = upload<S>(asked.z),
                               slope = upload<S>(asked.slope);
        Buffer<std::uint32_t, S> const triangle = upload<S>(asked.triangle), axis = upload<S>(asked.axis);
        Buffer<float, S> hit_x(n), hit_y(n), hit_z(n);
        Buffer<std::uint32_t, S> hit(n);
        fill_bytes(S, hit.view().data, 0xee, n * sizeof(std::uint32_t));
        double const s = time_of(S, [&] {
            launch(S, "answer queries", n,
                   AnswerQueries{axes_there.view(), there_.view().surfaces, x.view(), y.view(), z.view(),
                                 triangle.view(), slope.view(), axis.view(), hit_x.view(), hit_y.view(),
                                 hit_z.view(), hit.view()});
        });
        std::vector<std::uint32_t> const found = download(hit);
        std::vector<float> const fx = download(hit_x), fy = download(hit_y), fz = download(hit_z);
        std::size_t far = 0;
        for (std::size_t i = 0; i < n; ++i) {
            vec3 const start{asked.x[i], asked.y[i], asked.z[i]};
            bool const is_hit = found[i] != kNoLayerHit;
            float const texel = buffers_[asked.axis[i]].grid.texel;
            // A hit lies under a texel's centre: its distance differs by what the surfaces slope in a texel.
            far += is_far(truth.nearest[i], is_hit, is_hit ? glm::length(vec3{fx[i], fy[i], fz[i]} - start) : 0,
                          4 * texel * (1 + asked.slope[i]));
        }
        // The fewest bytes: 28 in and 16 out, two offsets and one sector of layers.
        fmt::print("  {:<6} look-ups: {:.0f} M/s, {:.2f} times as fast as rays, {:.0f} GB/s of the fewest bytes; "
                   "{:.2f} % of them more than 4 texels off, or hit or miss what rays do not\n",
                   kind, 1e-6 * double(n) / s, nearest_s_ / s, 1e-9 * double(n) * (28 + 16 + 64) / s,
                   100 * double(far) / double(n));
    }

    std::string name_;
    World const& world_;
    Options options_;
    WorldOn<S> there_;
    TriangleSoup soup_;
    SoupOn<S> soup_there_;
    ExactVisibility exact_;
    DirectionSet directions_ = make_directions(kDirections);
    std::optional<WorldBvh<S>> bvh_;
    std::vector<HitBufferOn<S>> buffers_;
    double nearest_s_ = 0;
};

template <Space S>
void measure(std::string const& name, Scene scene, Options const& options)
{
    Report report;
    World const world = build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
    SceneBench<S>(name, world, options).measure();
    std::fflush(stdout);
}

template <Space S>
void measure_all(std::vector<std::string> const& files, Options const& options)
{
    check_device(S);
    measure_ceilings<S>();
    if (files.empty()) {
        measure<S>("boxes-1M", generate_boxes(1'000'000, 0), options);
        measure<S>("atrium", generate_atrium({}), options);
        measure<S>("cornell", generate_cornell(), options);
    }
    for (std::string const& file : files) {
        Report report;
        measure<S>(std::filesystem::path(file).stem().string(), load_scene(file, report), options);
    }
}

} // namespace
} // namespace gi::bench

int main(int argc, char** argv)
try {
    gi::bench::Options options;
    bool on_host = false;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i) {
        std::string const a = argv[i];
        if (a == "--host")
            on_host = true;
        else if (a == "--rays" && i + 1 < argc)
            options.rays = std::stoul(argv[++i]);
        else if (a == "--dump" && i + 1 < argc)
            options.dump = argv[++i];
        else
            files.push_back(a);
    }
    if (on_host)
        gi::bench::measure_all<gi::Space::host>(files, options);
    else
        gi::bench::measure_all<gi::Space::device>(files, options);
} catch (std::exception const& e) {
    fmt::print(stderr, "bench_device: {}\n", e.what());
    return 2;
}
