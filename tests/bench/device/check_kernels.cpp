// The kernels of paths, step by step, by the host and by the device: both begin each step with the same state of all
// paths, and what the step leaves is compared path by path. Pictures hide what few paths do; this does not.
// Integers (triangles, numbers of scatterings, stages) must be equal; of other numbers is counted by how many units in
// the last place (ulp) they differ, as a device fuses products and sums, and the ten that differ most are printed.
//   check_kernels [--size N] [--passes N] [SCENE...]
//     default: 256 x 256 paths a step, 2 passes; cornell, mirror, ring, atrium
// Ends with 1 if more than one of 10,000 items have another integer or differ by more than 2^14 ulp (0.1 %).

#include "gi/core/report.h"
#include "gi/methods/paths/choose.h"
#include "gi/methods/paths/kernels/kernel_renderer.h"
#include "gi/methods/reference/kernel_paths.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <map>
#include <unordered_map>

namespace gi::bench {
namespace {

using Words = std::vector<std::uint32_t>;

/// The words of a struct that are no floating-point numbers.
template <class T>
std::vector<std::size_t> integers();
template <>
std::vector<std::size_t> integers<PathOnWay>()
{
    return {4, 6, 7, 8};
}
template <>
std::vector<std::size_t> integers<Hit>()
{
    return {0};
}
template <>
std::vector<std::size_t> integers<WaitingLight>()
{
    return {7, 9, 13, 14};
}
template <>
std::vector<std::size_t> integers<PathSample>()
{
    return {19};
}
template <>
std::vector<std::size_t> integers<PathSlot>()
{
    return {0, 1, 2, 3, 4, 5};
}
template <>
std::vector<std::size_t> integers<PathCarry>()
{
    return {4, 5, 6, 7, 8, 9, 10, 11};
}
template <>
std::vector<std::size_t> integers<PathLight>()
{
    return {12};
}
template <>
std::vector<std::size_t> integers<FirstSurface>()
{
    return {10, 11};
}
template <>
std::vector<std::size_t> integers<RayQuery>()
{
    return {7, 9};
}

/// Items as one after the other, of columns or of an array.
template <class T>
struct Items {
    Words words;
    std::size_t count = 0;

    std::uint32_t word(std::size_t item, std::size_t k) const { return words[k * count + item]; }
    T at(std::size_t item) const
    {
        typename ColumnView<T>::Words all;
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = word(item, k);
        return __builtin_bit_cast(T, all);
    }
};

template <class T, Space S>
Items<T> taken_from(ColumnBuffer<T, S>& columns)
{
    return {download(columns.words()), columns.size()};
}
template <class T, Space S>
void put(Items<T> const& items, ColumnBuffer<T, S>& columns)
{
    copy_bytes(S, columns.words().view().data, Space::host, items.words.data(),
               items.words.size() * sizeof(std::uint32_t));
}
template <class T, Space S>
void put(std::vector<T> const& values, Buffer<T, S>& there)
{
    copy_bytes(S, there.view().data, Space::host, values.data(), values.size() * sizeof(T));
}

/// Numbers as integers that sort in the same order.
std::int64_t place(float v)
{
    auto const bits = std::bit_cast<std::int32_t>(v + 0.0f);
    return bits < 0 ? std::int64_t(std::int32_t(0x80000000u)) - bits : bits;
}

/// What was found different of one kind of items after one kind of steps.
class Difference {
public:
    void item(std::string const& where, std::span<std::uint32_t const> host, std::span<std::uint32_t const> device,
              std::vector<std::size_t> const& integers)
    {
        ++items_;
        std::int64_t most = 0;
        bool other = false;
        for (std::size_t k = 0; k < host.size(); ++k) {
            if (host[k] == device[k]) continue;
            auto const h = std::bit_cast<float>(host[k]), d = std::bit_cast<float>(device[k]);
            if (std::ranges::find(integers, k) != integers.end()) {
                other = true;
                note(std::int64_t(1) << 40, fmt::format("{}, word {}: {:#x}, {:#x}", where, k, host[k], device[k]));
            } else if (!(std::isnan(h) && std::isnan(d))) {
                std::int64_t const ulp = std::isnan(h) || std::isnan(d) ? std::int64_t(1) << 32
                                         : std::abs(h - d) < 1e-30f     ? 0
                                                                        : std::abs(place(h) - place(d));
                most = std::max(most, ulp);
                if (ulp > kFew) note(ulp, fmt::format("{}, word {}: {:.9g}, {:.9g}", where, k, h, d));
            }
        }
        others_ += other;
        beyond_few_ += most > kFew;
        far_ += !other && most > kFar;
    }
    void missing(std::string const& where)
    {
        ++items_;
        ++others_;
        note(std::int64_t(1) << 41, where + ": only one of both has it");
    }
    /// @return whether it is within what rounding explains
    bool print(std::string const& name) const
    {
        bool const well = double(others_ + far_) <= 1e-4 * double(items_);
        fmt::print("  {:<34} {:>9} items, {:>7} with other integers, {:>7} beyond {} ulp, {:>7} beyond {} ulp{}\n", name,
                   items_, others_, beyond_few_, kFew, far_, kFar, well ? "" : "  FAILED");
        if (!well)
            for (auto it = worst_.rbegin(); it != worst_.rend(); ++it) fmt::print("      {}\n", it->second);
        return well;
    }

private:
    static constexpr std::int64_t kFew = 4, kFar = 1 << 14;

    void note(std::int64_t size, std::string const& what)
    {
        worst_.emplace(size, what);
        if (worst_.size() > 10) worst_.erase(worst_.begin());
    }

    std::uint64_t items_ = 0, others_ = 0, beyond_few_ = 0, far_ = 0;
    std::multimap<std::int64_t, std::string> worst_;
};

class Differences {
public:
    explicit Differences(std::string scene) : scene_(std::move(scene)) {}

    template <class T>
    void compare(std::string const& name, std::string const& where, T const& host, T const& device)
    {
        using W = typename ColumnView<T>::Words;
        W h = __builtin_bit_cast(W, host), d = __builtin_bit_cast(W, device);
        if constexpr (std::is_same_v<T, PathSample>) h[19] &= 0xffffffu, d[19] &= 0xffffffu; // then padding
        all_[name].item(scene_ + ", " + where, h, d, integers<T>());
    }
    void missing(std::string const& name, std::string const& where) { all_[name].missing(scene_ + ", " + where); }
    bool print() const
    {
        bool well = true;
        fmt::print("{}:\n", scene_);
        for (auto const& [name, difference] : all_) well &= difference.print(name);
        return well;
    }

private:
    std::string scene_;
    std::map<std::string, Difference> all_;
};

/// What a step of paths or slhb leaves.
struct StepOfPaths {
    Items<PathOnWay> paths;
    Items<RayQuery> queries;
    Items<Hit> hits;
    std::uint32_t count = 0;
    Items<WaitingLight> waiting;
    std::uint32_t waits = 0;
    std::vector<PathSample> samples;
};

template <Space S>
StepOfPaths step_of(typename KernelScene<S>::AfterStep const& now)
{
    return {taken_from(now.paths),       taken_from(now.queries), taken_from(now.hits),
            download(now.count).front(), taken_from(now.waiting), download(now.waits).front(),
            download(now.samples)};
}

/// Compares items of pixels, in whatever order they are. @param rest  (host's item, device's) -> compares more
template <class T, class Rest>
void compare_items(std::string const& name, std::size_t step, Items<T> const& host, std::size_t of_host,
                   Items<T> const& device, std::size_t of_device, Differences& to, Rest const& rest)
{
    std::unordered_map<std::uint32_t, std::size_t> of_pixel;
    for (std::size_t k = 0; k < of_device; ++k) of_pixel[device.at(k).pixel] = k;
    for (std::size_t k = 0; k < of_host; ++k) {
        T const item = host.at(k);
        std::string const where = fmt::format("step {}, pixel {}", step, item.pixel);
        auto const found = of_pixel.find(item.pixel);
        if (found == of_pixel.end()) {
            to.missing(name, where);
            continue;
        }
        to.compare(name, where, item, device.at(found->second));
        rest(where, k, found->second);
        of_pixel.erase(found);
    }
    for (auto const& [pixel, k] : of_pixel) to.missing(name, fmt::format("step {}, pixel {}", step, pixel));
}

void compare(std::string const& method, StepOfPaths const& host, StepOfPaths const& device, std::size_t number,
             Differences& to)
{
    bool const of_camera = host.count > 0 && host.paths.at(0).vertex == 0; // its rays leave hits and no light
    for (std::size_t p = 0; p < host.samples.size() && !of_camera; ++p)
        to.compare(method + ", light", fmt::format("step {}, pixel {}", number, p), host.samples[p],
                   device.samples[p]);
    compare_items(method + ", paths", number, host.paths, host.count, device.paths, device.count, to,
                  [&](std::string const& where, std::size_t k, std::size_t j) {
                      if (host.queries.count > 0)
                          to.compare(method + ", rays", where, host.queries.at(k), device.queries.at(j));
                      if (of_camera)
                          to.compare(method + ", first hits", where, host.hits.at(k), device.hits.at(j));
                  });
    compare_items(method + ", light of samples", number, host.waiting, host.waits, device.waiting, device.waits,
                  to, [](std::string const&, std::size_t, std::size_t) {});
}

template <Space S>
void trace_paths(World const& world, RenderSettings const& settings, Camera const& camera, int passes,
                 std::function<void(typename KernelScene<S>::AfterStep const&)> const& after)
{
    Report report;
    FrameView const eye{camera, settings.width, settings.height};
    bool const free = settings.of<PathAlgorithm>().surfaces == SurfacesBy::rays;
    KernelRenderer<S> renderer(world, {&eye, 1}, settings, make_soup(world), world.triangles.size(), report,
                               free ? FirstSurfaces::by_rays : FirstSurfaces::by_raster);
    renderer.scene().after_step = after;
    Accumulator sums(settings.width, settings.height);
    for (int k = 0; k < passes; ++k) renderer.pass(std::uint32_t(k), {&sums, 1});
}

void check_paths(std::string const& method, PathAlgorithm by, World const& world, RenderSettings const& asked,
                 int passes, Differences& to)
{
    Camera const& camera = world.cameras.front();
    RenderSettings settings = choose_settings(with(by, asked), world, make_soup(world));
    KernelRenderer<Space::host>::limit(settings);
    settings.of<SlhbSettings>().confirm = Confirming::on;
    std::vector<StepOfPaths> steps;
    trace_paths<Space::host>(world, settings, camera, passes,
                             [&](auto const& now) { steps.push_back(step_of<Space::host>(now)); });
    std::size_t number = 0;
    trace_paths<Space::device>(world, settings, camera, passes, [&](auto const& now) {
        StepOfPaths const& host = steps.at(number);
        compare(method, host, step_of<Space::device>(now), number, to);
        put(host.paths, now.paths); // so that both take the next step from the same state
        if (host.queries.count > 0) put(host.queries, now.queries), put(host.hits, now.hits);
        put(std::vector<std::uint32_t>{host.count}, now.count);
        put(host.waiting, now.waiting);
        put(std::vector<std::uint32_t>{host.waits}, now.waits);
        put(host.samples, now.samples);
        steps[number++] = {};
    });
}

/// What a step of the reference leaves.
struct StepOfReference {
    Items<PathSlot> slots;
    Items<PathCarry> carried;
    Items<PathLight> lights;
    Items<FirstSurface> seen;
    Items<RayQuery> queries, shadows;
    std::vector<std::uint32_t> added, taken;
};

template <Space S>
StepOfReference step_of(PathMemory<S>& m)
{
    return {taken_from(m.slots),   taken_from(m.carried), taken_from(m.lights), taken_from(m.seen),
            taken_from(m.queries), taken_from(m.shadows), download(m.added),    download(m.taken_paths)};
}

void compare(StepOfReference const& host, StepOfReference const& device, std::size_t number, Differences& to)
{
    auto const key = [](PathSlot const& s) { return std::uint64_t(s.number) << 32 | s.pixel; };
    std::unordered_map<std::uint64_t, std::size_t> of_path;
    for (std::size_t k = 0; k < device.slots.count; ++k)
        if (PathSlot const s = device.slots.at(k); s.stage != PathStage::idle) of_path[key(s)] = k;
    for (std::size_t k = 0; k < host.slots.count; ++k) {
        PathSlot h = host.slots.at(k);
        if (h.stage == PathStage::idle) continue;
        std::string const where = fmt::format("step {}, pixel {}, path {}", number, h.pixel, h.number);
        auto const found = of_path.find(key(h));
        if (found == of_path.end()) {
            to.missing("reference, paths", where);
            continue;
        }
        std::size_t const j = found->second;
        PathSlot d = device.slots.at(j);
        h.nearest_rays = h.shadow_rays = d.nearest_rays = d.shadow_rays = 0; // of all paths that the slot had
        for (PathSlot* const s : {&h, &d}) // whether the one before was added sooner is a matter of timing
            if (s->stage == PathStage::may_add) s->stage = PathStage::ended;
        to.compare("reference, paths", where, h, d);
        to.compare("reference, light", where, host.lights.at(k), device.lights.at(j));
        if (h.vertex > 0) to.compare("reference, first surfaces", where, host.seen.at(k), device.seen.at(j));
        if (host.shadows.at(k).reach > 0 || device.shadows.at(j).reach > 0)
            to.compare("reference, shadow rays", where, host.shadows.at(k), device.shadows.at(j));
        if (h.stage != PathStage::goes_on) continue;
        to.compare("reference, states", where, host.carried.at(k), device.carried.at(j));
        to.compare("reference, rays", where, host.queries.at(k), device.queries.at(j));
    }
}

template <Space S>
void trace_reference(World const& world, RenderSettings const& settings, Camera const& camera, int passes,
                     std::function<void(PathMemory<S>&)> const& after)
{
    Report report;
    KernelPaths<S> paths(world, settings, world.triangles.size(), report);
    PathSteps const steps{paths.prepare(), camera_rays(camera, settings.width, settings.height, world.origin),
                          settings.bounces, settings.seed, settings.filter, settings.width};
    paths.after_step = after;
    Accumulator sums(settings.width, settings.height);
    PassStop const never(nullptr);
    TiledPass pass(sums, std::uint32_t(passes), never);
    paths.add(steps, pass, 0, {}, sums);
}

void check_reference(World const& world, RenderSettings const& settings, int passes, Differences& to)
{
    Camera const& camera = world.cameras.front();
    std::vector<StepOfReference> steps;
    trace_reference<Space::host>(world, settings, camera, passes,
                                 [&](auto& now) { steps.push_back(step_of(now)); });
    std::size_t number = 0;
    trace_reference<Space::device>(world, settings, camera, passes, [&](auto& now) {
        StepOfReference const& host = steps.at(number);
        compare(host, step_of(now), number, to);
        put(host.slots, now.slots);
        put(host.carried, now.carried);
        put(host.lights, now.lights);
        put(host.seen, now.seen);
        put(host.queries, now.queries);
        put(host.shadows, now.shadows);
        put(host.added, now.added);
        put(host.taken, now.taken_paths);
        steps[number++] = {};
    });
}

Scene scene_of(std::string const& name, Report& report)
{
    if (name == "cornell") return generate_cornell();
    if (name == "mirror") return generate_mirror();
    if (name == "ring") return generate_ring();
    if (name == "atrium") return generate_atrium({});
    return load_scene(name, report);
}

bool check(std::string const& name, int size, int passes)
{
    Report report;
    World const world = build_world(std::make_shared<Scene const>(scene_of(name, report)), std::nullopt, report);
    Differences differences(name);
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.bounces = 8;
    check_paths("paths", PathAlgorithm{}, world, settings, passes, differences);
    check_paths("slhb", kSlhb, world, settings, passes, differences);
    check_reference(world, settings, passes, differences);
    return differences.print();
}

} // namespace
} // namespace gi::bench

int main(int argc, char** argv)
try {
    int size = 256, passes = 2;
    std::vector<std::string> scenes;
    for (int i = 1; i < argc; ++i) {
        std::string const a = argv[i];
        if (a == "--size" && i + 1 < argc)
            size = std::stoi(argv[++i]);
        else if (a == "--passes" && i + 1 < argc)
            passes = std::stoi(argv[++i]);
        else
            scenes.push_back(a);
    }
    if (scenes.empty()) scenes = {"cornell", "mirror", "ring", "atrium"};
    gi::check_device(gi::Space::device);
    if (gi::is_device_simulated()) fmt::print("the device is simulated: this checks the checks alone\n");
    bool well = true;
    for (std::string const& scene : scenes) well &= gi::bench::check(scene, size, passes);
    return well ? 0 : 1;
} catch (std::exception const& e) {
    fmt::print(stderr, "check_kernels: {}\n", e.what());
    return 2;
}
