// Measures the bias of slhb by paired differences. Renders with the same seed share axes, light samples and random
// numbers; they differ in using look-ups or exact rays, and shared axes or a direction of each path's own. So the
// difference of two means has far less noise than either; several seeds give its standard error.

#include "gi/core/durable_file.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/registry.h"
#include "gi/metrics/metrics.h"
#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/load_world.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numeric>

namespace viewer {
namespace {

using namespace gi;

struct AccuracyOptions {
    RenderOptions render;
    std::vector<std::string> scenes{"cornell", "atrium"}, directions{"icosahedron:80", "icosahedron:320"};
    std::vector<int> resolutions{32, 64, 128, 256, 512};
    std::uint32_t paths = 64, direction_paths = 256, reference_paths = 4096;
    int seeds = 8;
    std::string out;
};

/// Light of one render, or the difference of two renders.
struct Light {
    std::vector<float> direct, indirect;
};

double mean(std::vector<float> const& v)
{
    return std::accumulate(v.begin(), v.end(), 0.0) / double(std::max<std::size_t>(1, v.size()));
}

/// One per seed.
using Lights = std::vector<Light>;
using Part = std::vector<float> Light::*;

Lights combine(Lights a, Lights const& b, float factor)
{
    for (std::size_t k = 0; k < a.size(); ++k)
        for (Part const p : {&Light::direct, &Light::indirect})
            for (std::size_t i = 0; i < (a[k].*p).size(); ++i) (a[k].*p)[i] += factor * (b[k].*p)[i];
    return a;
}
Lights differences(Lights const& a, Lights const& b) { return combine(a, b, -1); }
Lights sums(Lights const& a, Lights const& b) { return combine(a, b, 1); }

struct Estimate {
    double value = 0, error = 0; ///< a mean and its standard error
};

/// Estimate of the picture's mean, in units of `unit`.
Estimate estimate(Lights const& lights, Part part, double unit)
{
    double const n = double(lights.size());
    double sum = 0, squares = 0;
    for (Light const& l : lights) sum += mean(l.*part);
    for (Light const& l : lights) squares += std::pow(mean(l.*part) - sum / n, 2);
    return {sum / n / unit, std::sqrt(squares / (n * (n - 1))) / unit};
}

Estimate operator-(Estimate a, Estimate b) { return {a.value - b.value, std::hypot(a.error, b.error)}; }

std::vector<float> mean_picture(Lights const& lights, Part part)
{
    std::vector<float> sum((lights[0].*part).size());
    for (Light const& l : lights)
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (l.*part)[k] / float(lights.size());
    return sum;
}

/// relMSE that remains with any number of paths and seeds. Uses products of different seeds, in which noise
/// averages out; so it may be slightly below 0.
double systematic_relmse(Lights const& differences, std::vector<float> const& reference)
{
    double const n = double(differences.size());
    double total = 0;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        double sum = 0, squares = 0, r = double(reference[k]);
        for (Light const& d : differences) {
            sum += double(d.indirect[k]);
            squares += double(d.indirect[k]) * double(d.indirect[k]);
        }
        total += (sum * sum - squares) / (n * (n - 1)) / (r * r + kRelativeFloor);
    }
    return total / double(reference.size());
}

/// Biases of one row; those of a single cause (of_*) are of indirect light.
struct Biases {
    Estimate direct, indirect, of_hit_buffers, of_shadow_maps, of_directions;
};

struct Rendered {
    Lights lights;
    double seconds = 0, lost_layers = 0;
};

/// One scene with its reference and its exact renders.
class Bench {
public:
    Bench(AccuracyOptions const& options, RenderOptions render, BenchTable& table, Report& report)
        : o_(options),
          table_(table),
          report_(report),
          scene_(render.scene),
          world_(load_world(render, report)),
          camera_(choose_camera(world_, camera_choice(render)).camera),
          settings_(make_settings(render))
    {
        settings_.checkpoint.clear();
        std::uint32_t const each = std::max(1u, o_.reference_paths / std::uint32_t(o_.seeds));
        Lights const reference = render_seeds("reference", {}, each, 1000).lights;
        reference_ = mean_picture(reference, &Light::indirect);
        Rendered const free = render_exactly({}, true, o_.direction_paths);
        free_ = free.lights;
        direct_ = estimate(free_, &Light::direct, 1).value;
        indirect_ = estimate(free_, &Light::indirect, 1).value;
        add({"exact rays", "free", std::monostate{}},
            {part(free_, &Light::direct) - part(reference, &Light::direct),
             part(free_, &Light::indirect) - part(reference, &Light::indirect),
             {},
             {},
             {}},
            std::monostate{}, free);
    }

    void stream() { add_rows("streamed", {}); }
    void store(std::string const& directions) { add_rows("stored", directions); }

private:
    struct Name {
        std::string schedule, directions;
        Cell hit_buffer;
    };

    Rendered render_seeds(char const* method, SlhbSettings const& slhb, std::uint32_t paths,
                          std::uint64_t first_seed)
    {
        Rendered r;
        StopRequest const stop;
        RenderSettings s = settings_;
        s.of<gi::SlhbSettings>() = slhb;
        s.paths = paths;
        for (int k = 0; k < o_.seeds; ++k) {
            s.seed = first_seed + std::uint64_t(k);
            Report report;
            RenderResult const result = find_method(method).render(world_, camera_, s, stop, {}, report);
            r.lights.push_back({result.picture.find("L1")->data, result.picture.find("L2")->data});
            r.seconds += result.seconds / o_.seeds;
            for (auto const& [what, loss] : report.losses()) {
                if (what == "layers beyond the limit of a texel") r.lost_layers += double(loss.count);
                report_.lose(what, loss.count, loss.first);
            }
        }
        return r;
    }
    SlhbSettings slhb(std::string const& directions) const
    {
        SlhbSettings s = settings_.of<gi::SlhbSettings>();
        s.schedule = directions.empty() ? Schedule::streamed : Schedule::stored;
        s.directions = directions;
        return s;
    }
    Rendered render_exactly(std::string const& directions, bool free, std::uint32_t paths)
    {
        SlhbSettings s = slhb(directions);
        s.exact = {.queries = true, .shadows = true, .directions = free};
        return render_seeds("slhb", s, paths, 1);
    }
    /// Estimate relative to the mean light of that part.
    Estimate part(Lights const& l, Part p) const
    {
        return estimate(l, p, p == &Light::direct ? direct_ : indirect_);
    }
    void add(Name const& name, Biases const& b, Cell systematic, Rendered const& r)
    {
        std::vector<Cell> row{scene_, name.schedule, name.directions, name.hit_buffer};
        for (Estimate const& e : {b.direct, b.indirect, b.of_hit_buffers, b.of_shadow_maps, b.of_directions}) {
            row.push_back(e.value);
            row.push_back(e.error);
        }
        row.push_back(systematic);
        row.push_back(measure_errors(mean_picture(r.lights, &Light::indirect), reference_, 3).relmse);
        row.push_back(r.lost_layers);
        row.push_back(r.seconds);
        table_.add(row);
        write(table_, o_.out);
    }
    void add_rows(char const* schedule, std::string const& directions);

    AccuracyOptions const& o_;
    BenchTable& table_;
    Report& report_;
    std::string scene_;
    World world_;
    Camera camera_;
    RenderSettings settings_;
    std::vector<float> reference_;
    Lights free_;
    double direct_ = 0, indirect_ = 0;
};

void Bench::add_rows(char const* schedule, std::string const& directions)
{
    // Streamed axes are uniform: their bias is 0 by construction. Not measuring it avoids
    // the noise of axes that all pixels share.
    bool const streamed = directions.empty();
    Lights const of_directions =
        streamed ? Lights{} : differences(render_exactly(directions, false, o_.direction_paths).lights, free_);
    Lights const exact = render_exactly(directions, false, o_.paths).lights;
    SlhbSettings s = slhb(directions);
    s.exact.queries = true;
    Lights const with_maps = render_seeds("slhb", s, o_.paths, 1).lights;
    s.exact.queries = false;
    Lights const of_maps = differences(with_maps, exact);
    for (int const resolution : o_.resolutions) {
        s.resolution = resolution;
        Rendered const r = render_seeds("slhb", s, o_.paths, 1);
        Lights const of_buffers = differences(r.lights, with_maps);
        Lights all = differences(r.lights, exact);
        if (!streamed) all = sums(all, of_directions);
        add({schedule, streamed ? "all" : directions, double(resolution)},
            {part(all, &Light::direct), part(all, &Light::indirect), part(of_buffers, &Light::indirect),
             part(of_maps, &Light::indirect), streamed ? Estimate{0, 0} : part(of_directions, &Light::indirect)},
            systematic_relmse(all, reference_), r);
    }
}

int run(AccuracyOptions& o)
{
    check_folder(o.out);
    gi::make_folder(o.out);
    BenchTable table =
        start_table("accuracy", "Bias of slhb, by paired differences",
                    {"scene", "schedule", "directions", "hit_buffer", "bias_direct", "bias_direct_error",
                     "bias_indirect", "bias_indirect_error", "of_hit_buffers", "of_hit_buffers_error",
                     "of_shadow_maps", "of_shadow_maps_error", "of_directions", "of_directions_error",
                     "systematic_relmse_indirect", "relmse_indirect", "lost_layers", "seconds"});
    table.facts = {{"size", o.render.size},
                   {"bounces", std::to_string(o.render.settings.bounces)},
                   {"seeds", std::to_string(o.seeds)},
                   {"paths", std::to_string(o.paths)},
                   {"direction_paths", std::to_string(o.direction_paths)},
                   {"reference", fmt::format("path tracing, {} paths per pixel", o.reference_paths)}};
    o.render.out = "unused";
    Report report;
    for (std::string const& scene : o.scenes) {
        RenderOptions options = o.render;
        options.scene = scene;
        Bench bench(o, options, table, report);
        for (std::string const& directions : o.directions) bench.store(directions);
        bench.stream();
    }
    show(table, o.out, o.render.json);
    print_losses(report);
    return 0;
}

} // namespace

void add_bench_accuracy(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<AccuracyOptions>();
    o->render.size = "64x64";
    o->render.settings.bounces = 2;
    CLI::App* const c =
        bench.add_subcommand("accuracy", "Measure the bias of slhb for sets of directions and hit buffer sizes.");
    auto const list = [&](char const* name, auto& values, char const* help) {
        c->add_option(name, values, help)->delimiter(',')->capture_default_str()->allow_extra_args(false);
    };
    auto const paths = [&](char const* name, std::uint32_t& value, char const* help) {
        c->add_option(name, value, help)->check(CLI::Range(1u, 1u << 24))->capture_default_str();
    };
    list("--scene", o->scenes, "files or names, comma-separated");
    list("--directions", o->directions, "direction sets of the stored schedule, comma-separated");
    list("--hit-buffers", o->resolutions, "hit buffer sizes, texels on a side, comma-separated");
    declare_view_options(*c, o->render);
    declare_lens_options(*c, o->render);
    c->add_option("--size", o->render.size, "width x height, pixels")->capture_default_str();
    declare_option(*c, o->render.settings, "bounces")->check(CLI::Range(1, 1000));
    c->add_option("--seeds", o->seeds, "renders of each kind, for the standard errors")
        ->check(CLI::Range(2, 1000))
        ->capture_default_str();
    paths("--paths", o->paths, "paths per pixel and seed");
    paths("--direction-paths", o->direction_paths, "the same, for comparing directions by exact rays");
    paths("--reference-paths", o->reference_paths, "paths per pixel of the reference, all seeds together");
    declare_option(*c, o->render.settings, "threads");
    declare_method_options(
        *c, o->render.settings, {"slhb"},
        {"device", "schedule", "look-ups", "shadows", "radiance-cache", "directions", "hit-buffer"});
    c->add_option("-o,--out", o->out, "folder for accuracy.json and accuracy.csv")->required();
    c->add_flag("--json", o->render.json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench accuracy --scene cornell --directions icosahedron:80 --hit-buffers 32 --size 16x16 --seeds 2 --paths 8 --direction-paths 8 --reference-paths 32 --out accuracy

bias_direct and bias_indirect are the relative biases of L1 and L2, averaged over pixels and channels; columns
ending in _error are standard errors over the seeds. bias_indirect is the sum of three parts, each a difference of
renders with the same seeds and light samples, the first two also with the same axes and random numbers:
  of_hit_buffers  slhb minus A, A = slhb with exact rays along its axes
  of_shadow_maps  A minus B, B = A with exact rays to its light samples
  of_directions   stored: B minus C, C = exact rays, cosine-distributed, separately for each path; streamed: 0, as
                  its axes are uniform
slhb decides what is doubtful by exact rays; with --confirm off, the first two are those of look-ups alone.
The row "exact rays" is C minus the reference: it should be 0 within its standard error.
systematic_relmse_indirect is the relMSE of L2 that remains with any number of paths and seeds. It is computed from
products of different seeds, so noise may make it negative; it does not contain the error of the stored set itself,
which every seed rotates. relmse_indirect is the relMSE of the mean of all seeds against the reference.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
