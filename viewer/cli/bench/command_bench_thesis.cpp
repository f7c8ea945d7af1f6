#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/progress.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/registry.h"
#include "gi/metrics/compare.h"
#include "gi/scene/generate/generate.h"
#include "viewer/base/interrupt.h"
#include "viewer/bench/bench_record.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/render_options.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

namespace viewer {
namespace {

using namespace gi;

struct ThesisOptions {
    std::string out;
    std::vector<std::string> tables;
    int size = 0, paths = 64, repeats = 1;
    std::uint32_t triangles = 0, most_triangles = 1'000'000, reference_paths = 1024;
    bool json = false;
};

constexpr std::array kTables{"6.1", "6.2", "6.3", "6.4", "6.5"};

/// A row of the thesis's tables. @param published  ms of a frame, in table 6.5 rays per second
struct Row {
    char const* table;
    std::uint32_t triangles;
    char const* directions;
    int hit_buffer, paths, bounces;
    std::optional<double> published, published_peer{};
};

/// Printed are the figures of the page that has the table; table 6.3 is a picture in the copy that we have.
std::vector<Row> rows_of_thesis(int paths)
{
    constexpr char const* kMost = "icosahedron:320";
    std::vector<Row> rows;
    constexpr std::array<std::uint32_t, 9> kTriangles{2'000,   4'000,   8'000,   16'000,   64'000,
                                                      125'000, 250'000, 500'000, 1'000'000};
    constexpr double kTable1[3][9] = {{74.49, 74.55, 75.00, 75.80, 81.82, 88.70, 102.17, 128.69, 177.50},
                                      {143.37, 143.82, 144.37, 145.36, 150.30, 158.43, 171.48, 197.74, 246.54},
                                      {206.75, 208.43, 209.33, 210.35, 216.30, 223.44, 236.70, 263.20, 311.70}};
    for (std::size_t t = 0; t < kTriangles.size(); ++t)
        for (int bounces = 1; bounces <= 3; ++bounces)
            rows.push_back({"6.1", kTriangles[t], kMost, 128, paths, bounces, kTable1[bounces - 1][t]});
    constexpr std::pair<char const*, double> kTable2[] = {
        {"icosahedron:20", 71.63}, {"icosahedron:80", 108.67}, {kMost, 169.48},
        {"octahedron:8", 63.43},   {"octahedron:32", 87.39},   {"octahedron:128", 128.32},
        {"halton:144", 135.38},    {"halton:256", 162.07},     {"halton:320", 175.27}};
    for (auto const& [set, ms] : kTable2) rows.push_back({"6.2", 250'000, set, 128, paths, 2, ms});
    for (std::uint32_t const t : kTriangles)
        if (t >= 16'000)
            for (int const r : {16, 32, 64, 128, 256})
                rows.push_back({"6.3", t, kMost, r, paths, 2, std::nullopt});
    constexpr int kPaths[] = {2, 10, 40, 80, 160, 320, 640};
    constexpr std::pair<std::uint32_t, std::array<double, 7>> kTable4[] = {
        {2'000, {38, 152, 580, 1'155, 2'300, 4'579, 9'145}},
        {250'000, {73, 209, 715, 1'386, 2'728, 5'412, 10'784}},
        {1'000'000, {151, 349, 1'090, 2'077, 4'003, 8'006, 15'904}}};
    for (auto const& [t, ms] : kTable4)
        for (std::size_t k = 0; k < std::size(kPaths); ++k)
            rows.push_back({"6.4", t, kMost, 128, kPaths[k], 5, ms[k]});
    constexpr std::tuple<std::uint32_t, double, double> kTable5[] = {
        {100, 506.0e6, 50.58e6},   {2'000, 496.3e6, 14.38e6},  {14'000, 489.4e6, 12.22e6},
        {70'000, 481.5e6, 9.16e6}, {250'000, 475.6e6, 8.39e6}, {1'000'000, 427.4e6, 8.65e6}};
    for (auto const& [t, own, optix] : kTable5) rows.push_back({"6.5", t, kMost, 128, paths, 2, own, optix});
    return rows;
}

/// A picture by a method, and how long it took.
struct Made {
    Measured frame_ms;
    double structures_ms = 0, rays_per_s = 0; ///< of the rays, without building what they go through
    double relmse = 0, flip = 0, bias = 0;    ///< of indirect light
};

class Thesis {
public:
    Thesis(ThesisOptions const& options, StopRequest const& stop) : o_(options), stop_(stop)
    {
        table_ = start_table("thesis", "Tables 6.1 to 6.5 of Yu 2012, with the error beside each time",
                             {"table",           "triangles",
                              "directions",      "hit_buffer",
                              "size_px",         "paths",
                              "bounces",         "frame_ms",
                              "published_ms",    "build_ms",
                              "rays_per_s",      "published_rays_per_s",
                              "l2_relmse",       "l2_flip",
                              "l2_bias",         "paths_ms",
                              "paths_l2_relmse", "paths_l2_flip",
                              "embree_ms",       "embree_l2_relmse",
                              "embree_l2_flip",  "embree_rays_per_s",
                              "optix_rays_per_s"});
        table_.facts = {
            {"schedule", "stored"},
            {"reference", fmt::format("path tracing, {} paths per pixel", o_.reference_paths)},
            {"published", "Yu 2012, on a GeForce GTX 480; its models are a statue and others in a room"}};
    }

    /// Throws InputError if no row is wanted, Interrupted on a request to stop; finished rows are saved.
    void run()
    {
        std::vector<Row> rows = rows_of_thesis(o_.paths);
        std::erase_if(rows, [&](Row const& r) {
            bool const wanted = o_.tables.empty() || std::ranges::find(o_.tables, r.table) != o_.tables.end();
            return !wanted || r.triangles > o_.most_triangles || (o_.triangles > 0 && r.triangles != o_.triangles);
        });
        if (rows.empty())
            throw InputError("none of these tables has a row with such a model",
                             "they are told apart by --tables, --triangles and --most-triangles",
                             "choose those of the thesis, e.g. --tables 6.1 --triangles 250000");
        ProgressBar bar("thesis");
        for (std::size_t k = 0; k < rows.size(); ++k) {
            at_step_ = [&, k](char const* method, double done) {
                Row const& r = rows[k];
                bar.update(double(k) / double(rows.size()),
                           fmt::format("table {}, {} triangles, {} paths: {} {:.0f} %", r.table, r.triangles,
                                       r.paths, method, 100 * done));
            };
            add(rows[k]);
            write(table_, o_.out);
        }
    }
    BenchTable const& table() const { return table_; }

private:
    /// Room with a displaced sphere of so many triangles, like the thesis's statue; for the fewest, the Cornell box.
    void take_model(std::uint32_t triangles)
    {
        if (triangles == triangles_) return;
        Report report;
        Scene scene = triangles < 1000 ? generate_cornell() : generate_sphere(triangles, 0);
        world_ = build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
        triangles_ = triangles;
        references_.clear();
        peers_.clear();
    }
    int size_of(Row const& r) const
    {
        return o_.size > 0 ? o_.size : std::string_view(r.table) == "6.4" ? 1024 : 512;
    }
    RenderSettings settings(int size, std::uint32_t paths, int bounces, std::uint64_t seed) const
    {
        RenderSettings s;
        s.width = s.height = size;
        s.paths = paths;
        s.bounces = bounces;
        s.seed = seed;
        return s;
    }
    RenderResult render(char const* method, RenderSettings const& s, std::string const& what, Report& report) const
    {
        RenderProgress const progress = [&](RenderStatus const& status) {
            at_step_(what.c_str(), status.fraction);
        };
        RenderResult result = find_method(method).render(world_, world_.cameras.at(0), s, stop_, progress, report);
        if (result.end == RenderEnd::interrupted) throw Interrupted();
        return result;
    }
    Picture const& reference(int size, int bounces)
    {
        auto const at = references_.find({size, bounces});
        if (at != references_.end()) return at->second;
        Report unused;
        RenderResult const made =
            render("reference", settings(size, o_.reference_paths, bounces, 99), "converged picture", unused);
        return references_[{size, bounces}] = made.picture;
    }
    Made make(char const* method, RenderSettings const& s)
    {
        Made made;
        std::vector<double> frames;
        RenderResult result;
        for (int k = 0; k < o_.repeats; ++k) {
            Report report;
            frames.push_back(1e3 * seconds_of([&] { result = render(method, s, method, report); }));
            made.structures_ms = 0;
            for (auto const& [stage, seconds] : report.times())
                if (stage.starts_with("build (")) made.structures_ms += 1e3 * seconds;
        }
        made.frame_ms = summarise(frames);
        made.rays_per_s = 1e3 * result.rays / std::max(made.frame_ms.median - made.structures_ms, 1e-3);
        for (NamedValue const& v :
             compare(result.picture, reference(s.width, s.bounces), {"relmse", "flip", "bias"}, "L2").values) {
            if (v.name == "relmse") made.relmse = v.value;
            if (v.name == "flip") made.flip = v.value;
            if (v.name == "bias") made.bias = v.value - 1;
        }
        return made;
    }
    /// The same for all rows that differ in hit buffers alone.
    Made const& peer(char const* method, int size, Row const& r)
    {
        auto const [at, fresh] = peers_.try_emplace({method, size, r.paths, r.bounces});
        if (fresh) at->second = make(method, settings(size, std::uint32_t(r.paths), r.bounces, 1));
        return at->second;
    }
    void add(Row const& r)
    {
        take_model(r.triangles);
        int const size = size_of(r);
        RenderSettings s = settings(size, std::uint32_t(r.paths), r.bounces, 1);
        SlhbSettings& buffers = s.of<SlhbSettings>();
        buffers.schedule = Schedule::stored;
        buffers.directions = r.directions;
        buffers.resolution = r.hit_buffer;
        buffers.confirm = Confirming::off;
        Made const slhb = make("slhb", s);
        Made const &paths = peer("paths", size, r), &embree = peer("reference", size, r);
        auto const known = [](std::optional<double> value) { return value ? Cell(*value) : Cell(); };
        bool const of_rays = std::string_view(r.table) == "6.5";
        table_.add({std::string(r.table),
                    double(world_.triangles.size()),
                    std::string(r.directions),
                    double(r.hit_buffer),
                    double(size),
                    double(r.paths),
                    double(r.bounces),
                    slhb.frame_ms,
                    of_rays ? Cell() : known(r.published),
                    slhb.structures_ms,
                    slhb.rays_per_s,
                    of_rays ? known(r.published) : Cell(),
                    slhb.relmse,
                    slhb.flip,
                    slhb.bias,
                    paths.frame_ms,
                    paths.relmse,
                    paths.flip,
                    embree.frame_ms,
                    embree.relmse,
                    embree.flip,
                    embree.rays_per_s,
                    known(r.published_peer)});
    }

    ThesisOptions const& o_;
    StopRequest const& stop_;
    std::function<void(char const* what, double done)> at_step_;
    BenchTable table_;
    std::uint32_t triangles_ = 0;
    World world_;
    std::map<std::pair<int, int>, Picture> references_;                 ///< by size and bounces
    std::map<std::tuple<std::string_view, int, int, int>, Made> peers_; ///< by method, size, paths and bounces
};

int run(ThesisOptions const& o)
{
    check_folder(o.out);
    gi::make_folder(o.out);
    StopRequest stop;
    InterruptGuard const guard(stop);
    Thesis thesis(o, stop);
    try {
        thesis.run();
    } catch (Interrupted const&) {
        if (!thesis.table().rows.empty()) show(thesis.table(), o.out, o.json);
        fmt::print(
            stderr,
            "note: interrupted: {} rows are saved; data/batch/thesis.yaml makes tasks of them, and goes on\n",
            thesis.table().rows.size());
        return interrupted_code();
    }
    show(thesis.table(), o.out, o.json);
    return 0;
}

} // namespace

void add_bench_thesis(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<ThesisOptions>();
    CLI::App* const c =
        bench.add_subcommand("thesis", "Repeat tables 6.1 to 6.5 of Yu 2012, with errors and peers.");
    c->add_option("--tables", o->tables, "which, comma-separated (default: all)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(std::vector<std::string>(kTables.begin(), kTables.end())));
    c->add_option("--size", o->size, "pixels on a side (default: as published, 512, in table 6.4 1024)")
        ->check(CLI::Range(1, 8192));
    c->add_option("--paths", o->paths, "paths per pixel, but in table 6.4")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    c->add_option("--triangles", o->triangles, "only models of so many, e.g. 250000")
        ->check(CLI::Range(1u, 100'000'000u));
    c->add_option("--most-triangles", o->most_triangles, "leave out larger models")
        ->check(CLI::Range(100u, 100'000'000u))
        ->capture_default_str();
    c->add_option("--reference-paths", o->reference_paths, "paths per pixel of the reference")
        ->check(CLI::Range(1u, 1u << 24))
        ->capture_default_str();
    c->add_option("--repeats", o->repeats, "measurements of each time; rows hold medians")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for thesis.json and thesis.csv")->required();
    c->add_flag("--json", o->json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench thesis --tables 6.1,6.5 --size 16 --paths 2 --most-triangles 2000 --reference-paths 8 --out thesis

frame_ms is the time of the whole frame: hit buffers of all axes (build_ms alone), shadow maps, G-buffers and
paths. l2_*: errors of indirect light, by look-ups alone (--confirm off). paths and embree: the methods paths and reference, with as many paths and
bounces. rays_per_s counts look-ups and rays, and leaves out the building of hit buffers or of the tree.
At full size a CPU takes hours: data/batch/thesis.yaml makes tasks of it, of which the finished ones are kept.
bench report FOLDER... draws curves of time and error, and says how they grow.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
