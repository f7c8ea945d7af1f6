#include "gi/core/durable_file.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/registry.h"
#include "gi/metrics/metrics.h"
#include "gi/scene/generate/generate.h"
#include "viewer/bench/bench_record.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/render_options.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <map>
#include <memory>

namespace viewer {
namespace {

using namespace gi;

struct ThesisOptions {
    std::string out;
    int size = 256, paths = 64, repeats = 1;
    std::uint32_t most_triangles = 1'000'000, reference_paths = 1024;
    bool json = false;
};

/// Room with a displaced sphere, of 2K to 1M triangles like the statue of the thesis, with its reference pictures.
struct Model {
    World world;
    std::map<int, Picture> reference; ///< by bounces
};

class Thesis {
public:
    explicit Thesis(ThesisOptions const& options) : o_(options)
    {
        table_ = start_table("thesis", "Tables 6.1 to 6.4 of Yu 2012, with the error beside each time",
                             {"table", "triangles", "directions", "hit_buffer", "paths", "bounces", "frame_ms",
                              "build_ms", "relmse", "bias"});
        table_.facts = {{"size", fmt::format("{0}x{0}", o_.size)},
                        {"schedule", "stored"},
                        {"reference", fmt::format("path tracing, {} paths per pixel", o_.reference_paths)}};
    }

    void run()
    {
        constexpr std::uint32_t kTriangles[] = {2'000,   4'000,   8'000,   16'000,   64'000,
                                                125'000, 250'000, 500'000, 1'000'000};
        for (std::uint32_t const t : kTriangles)
            for (int const bounces : {1, 2, 3}) row("6.1", t, "icosahedron:320", 128, o_.paths, bounces);
        for (char const* set : {"icosahedron:20", "icosahedron:80", "icosahedron:320", "octahedron:8",
                                "octahedron:32", "octahedron:128", "halton:144", "halton:256", "halton:320"})
            row("6.2", 250'000, set, 128, o_.paths, 2);
        for (std::uint32_t const t : kTriangles)
            if (t >= 16'000)
                for (int const r : {16, 32, 64, 128, 256}) row("6.3", t, "icosahedron:320", r, o_.paths, 2);
        for (int const paths : {2, 10, 40, 160, 640})
            for (int const bounces : {1, 3, 5}) row("6.4", 1'000'000, "icosahedron:320", 128, paths, bounces);
    }
    BenchTable const& table() const { return table_; }

private:
    Model& model(std::uint32_t triangles)
    {
        if (triangles != triangles_) {
            Report report;
            model_ = {
                build_world(std::make_shared<Scene const>(generate_sphere(triangles, 0)), std::nullopt, report),
                {}};
            triangles_ = triangles;
        }
        return model_;
    }
    RenderSettings settings(std::uint32_t paths, int bounces, std::uint64_t seed) const
    {
        RenderSettings s;
        s.width = s.height = o_.size;
        s.paths = paths;
        s.bounces = bounces;
        s.seed = seed;
        return s;
    }
    void row(char const* name, std::uint32_t triangles, std::string const& directions, int resolution, int paths,
             int bounces)
    {
        if (triangles > o_.most_triangles) return;
        Model& m = model(triangles);
        StopRequest const stop;
        Camera const& camera = m.world.cameras.at(0);
        Report unused;
        auto const [reference, fresh] = m.reference.try_emplace(bounces);
        if (fresh)
            reference->second =
                find_method("reference")
                    .render(m.world, camera, settings(o_.reference_paths, bounces, 99), stop, {}, unused)
                    .picture;
        RenderSettings s = settings(std::uint32_t(paths), bounces, 1);
        s.of<gi::SlhbSettings>().schedule = Schedule::stored;
        s.of<gi::SlhbSettings>().directions = directions;
        s.of<gi::SlhbSettings>().resolution = resolution;
        std::vector<double> frame, build;
        ErrorSums errors;
        for (int k = 0; k < o_.repeats; ++k) {
            Report report;
            RenderResult result;
            frame.push_back(1e3 * seconds_of([&] {
                                result = find_method("slhb").render(m.world, camera, s, stop, {}, report);
                            }));
            for (auto const& [stage, seconds] : report.times())
                if (stage == "build (hit buffers)") build.push_back(1e3 * seconds);
            errors = measure_errors(result.picture.find("color")->data, reference->second.find("color")->data, 3);
        }
        table_.add({std::string(name), double(m.world.triangles.size()), directions, double(resolution),
                    double(paths), double(bounces), summarise(frame), summarise(build), errors.relmse,
                    errors.mean_bias - 1});
        write(table_, o_.out);
    }

    ThesisOptions const& o_;
    BenchTable table_;
    Model model_;
    std::uint32_t triangles_ = 0;
};

int run(ThesisOptions const& o)
{
    check_folder(o.out);
    gi::make_folder(o.out);
    Thesis thesis(o);
    thesis.run();
    show(thesis.table(), o.out, o.json);
    return 0;
}

} // namespace

void add_bench_thesis(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<ThesisOptions>();
    CLI::App* const c = bench.add_subcommand("thesis", "Repeat tables 6.1 to 6.4 of Yu 2012, with errors.");
    c->add_option("--size", o->size, "pixels on a side")->check(CLI::Range(1, 8192))->capture_default_str();
    c->add_option("--paths", o->paths, "paths per pixel, tables 6.1 to 6.3")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    c->add_option("--most-triangles", o->most_triangles, "leave out larger models")
        ->check(CLI::Range(2000u, 100'000'000u))
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
  lightwell bench thesis --size 16 --paths 2 --most-triangles 2000 --reference-paths 8 --out thesis

frame_ms is the time of the whole frame: hit buffers of all axes (build_ms alone), shadow maps, G-buffers and
paths. The thesis used 512 x 512 pixels on a GTX 480.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
