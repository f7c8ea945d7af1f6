#include "viewer/bench/sweep.h"

#include "gi/core/durable_file.h"
#include "gi/filter/denoise.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/compare.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/sweep_reference.h"
#include "viewer/offline/render_record.h"
#include "viewer/report/table_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <set>

namespace viewer {
namespace {

namespace fs = std::filesystem;

/// Samples of all repeats of one method with one budget.
struct Samples {
    std::vector<double> frame_s, trace_s, paths, mrays_per_s, relmse, relmse_indirect, flip, bias;
    std::string picture, flip_map;
};

class Sweep {
public:
    Sweep(SweepOptions const& options, SweepPlan const& plan, gi::StopRequest const& stop, gi::Report& report)
        : o_(options), plan_(plan), stop_(stop), report_(report), bar_("sweep", !options.render.quiet)
    {
        for (double const budget : plan.budgets_s) total_s_ += budget;
        total_s_ *= double(plan.scenes.size() * plan.methods.size()) * o_.repeats;
    }

    /// @return false if it was interrupted
    bool run(SweepScene const& scene, SweepReference const& reference, BenchTable& table);

    std::set<std::string> const& notes() const { return notes_; }

private:
    gi::RenderSettings settings(SweepMethod const& method, double budget_s, int repeat) const;
    gi::RenderResult frame(gi::Method const& method, SweepScene const& scene, gi::RenderSettings const& s,
                           gi::RenderProgress const& progress, gi::Report& report) const;
    void warm_up(SweepScene const& scene);
    bool measure(SweepScene const& scene, SweepReference const& reference, std::size_t method, std::size_t budget,
                 int repeat, Samples& into);
    void save(SweepScene const& scene, SweepMethod const& method, std::string const& budget,
              gi::RenderSettings const& settings, gi::RenderResult& result, SweepReference const& reference,
              Samples& into);

    SweepOptions const& o_;
    SweepPlan const& plan_;
    gi::StopRequest const& stop_;
    gi::Report& report_;
    gi::ProgressBar bar_;
    double total_s_ = 0, done_s_ = 0;
    double filter_s_ = 0;         ///< time of the filter per frame
    std::set<std::string> notes_; ///< from the comparisons
};

gi::RenderSettings Sweep::settings(SweepMethod const& method, double budget_s, int repeat) const
{
    gi::RenderSettings s = settings_of(method, plan_.settings);
    constexpr double kLeast = 1e-4; // s; 0 would mean no budget
    if (budget_s > 0) s.budget_s = std::max(kLeast, budget_s - filter_s_);
    s.seed = std::uint64_t(repeat) + 1;
    return s;
}

/// Renders and filters a picture: structures, paths and filter.
gi::RenderResult Sweep::frame(gi::Method const& method, SweepScene const& scene, gi::RenderSettings const& s,
                              gi::RenderProgress const& progress, gi::Report& report) const
{
    gi::RenderResult result = method.render(scene.world, scene.camera, s, stop_, progress, report);
    if (plan_.filter.denoiser != gi::Denoiser::none) gi::denoise(result.picture, plan_.filter);
    return result;
}

/// Renders once with each method without measuring, as the first render also starts threads and fills caches.
/// Measures the time of the filter.
void Sweep::warm_up(SweepScene const& scene)
{
    filter_s_ = 0;
    gi::Report unused;
    for (SweepMethod const& m : plan_.methods) {
        if (stop_.requested()) return;
        gi::RenderSettings s = settings(m, 0, 0);
        s.paths = 2;
        gi::RenderResult result = frame(m.method, scene, s, {}, unused);
        if (plan_.filter.denoiser != gi::Denoiser::none)
            filter_s_ = seconds_of([&] { gi::denoise(result.picture, plan_.filter); });
    }
}

bool Sweep::measure(SweepScene const& scene, SweepReference const& reference, std::size_t m, std::size_t b,
                    int repeat, Samples& into)
{
    SweepMethod const& method = plan_.methods[m];
    gi::RenderSettings const s = settings(method, plan_.budgets_s[b], repeat);
    auto const show = [&](gi::RenderStatus const& status) {
        bar_.update(
            (done_s_ + s.budget_s * status.fraction) / total_s_,
            fmt::format("{}, {}, {}, {}/{}", scene.name, method.name, o_.budgets[b], repeat + 1, o_.repeats));
    };
    gi::RenderResult result;
    double const frame_s = seconds_of([&] { result = frame(method.method, scene, s, show, report_); });
    if (result.end == gi::RenderEnd::interrupted) return false;
    done_s_ += s.budget_s;

    into.frame_s.push_back(frame_s);
    into.trace_s.push_back(result.seconds);
    into.paths.push_back(result.paths);
    into.mrays_per_s.push_back(result.seconds > 0 ? result.rays / result.seconds * 1e-6 : std::nan(""));
    gi::Comparison const c = gi::compare(result.picture, reference.picture, {"relmse", "flip", "bias"}, "color");
    notes_.insert(c.notes.begin(), c.notes.end());
    for (gi::NamedValue const& v : c.values) {
        if (v.name == "relmse") into.relmse.push_back(v.value);
        if (v.name == "flip") into.flip.push_back(v.value);
        if (v.name == "bias") into.bias.push_back(v.value);
    }
    if (result.picture.find("L2") != nullptr && reference.picture.find("L2") != nullptr)
        into.relmse_indirect.push_back(
            gi::compare(result.picture, reference.picture, {"relmse"}, "L2").values.front().value);
    if (repeat == 0) save(scene, method, o_.budgets[b], s, result, reference, into);
    return true;
}

void Sweep::save(SweepScene const& scene, SweepMethod const& method, std::string const& budget,
                 gi::RenderSettings const& s, gi::RenderResult& result, SweepReference const& reference,
                 Samples& into)
{
    gi::Picture& picture = result.picture;
    fs::path const folder = o_.out;
    std::string const stem = picture_stem(scene.name, method.name, budget);
    into.picture = stem + ".png";
    into.flip_map = stem + "_flip.png";
    int width = 0, height = 0;
    auto const difference = gi::difference_image(picture, reference.picture, "color", width, height);
    gi::write_png(folder / into.flip_map, width, height, difference);
    gi::write_png(folder / into.picture, picture.width, picture.height,
                  gi::tone_map_bytes(*picture.find("color"), {}));
    RenderOptions options = scene.options;
    options.method = method.method.name;
    picture.metadata = make_metadata(options, s, result);
    std::erase_if(picture.layers, [](gi::Layer const& l) { return l.name != "color" && l.name != "variance"; });
    gi::write_exr(folder / (stem + ".exr"), picture, gi::PixelType::single, report_);
}

bool Sweep::run(SweepScene const& scene, SweepReference const& reference, BenchTable& table)
{
    warm_up(scene);
    std::size_t const n = plan_.methods.size();
    for (std::size_t b = 0; b < plan_.budgets_s.size(); ++b) {
        std::vector<Samples> samples(n);
        bool goes_on = !stop_.requested();
        // In turns, so that a slower machine affects all methods equally.
        for (int repeat = 0; repeat < o_.repeats && goes_on; ++repeat)
            for (std::size_t i = 0; i < n && goes_on; ++i) {
                std::size_t const m = (std::size_t(repeat) + i) % n;
                goes_on = measure(scene, reference, m, b, repeat, samples[m]) && !stop_.requested();
            }
        for (std::size_t m = 0; m < n; ++m) {
            Samples const& s = samples[m];
            if (s.frame_s.empty()) continue;
            table.add({scene.name, plan_.methods[m].name, plan_.budgets_s[b], summarise(s.frame_s),
                       summarise(s.trace_s), summarise(s.paths), summarise(s.mrays_per_s), summarise(s.relmse),
                       s.relmse_indirect.empty() ? Cell() : summarise(s.relmse_indirect), summarise(s.flip),
                       summarise(s.bias), double(s.frame_s.size()), reference.relmse, s.picture, s.flip_map,
                       reference.png_file});
        }
        write(table, o_.out);
        if (!goes_on) return false;
    }
    return true;
}

/// Description of a reference file, with its method and paths if this program wrote it.
std::string describe_reference(std::string const& file, gi::Picture const& picture)
{
    auto const method = picture.metadata.find("method"), paths = picture.metadata.find("paths");
    if (method == picture.metadata.end() || paths == picture.metadata.end()) return file;
    return fmt::format("{}: method {}, {} paths per pixel", file, method->second, paths->second);
}

BenchTable empty_table(SweepOptions const& o, SweepPlan const& plan)
{
    BenchTable table = start_table(
        "sweep",
        o.render.denoise == "none" ? "Error over time, by method"
                                   : "Error over time, with the filter " + o.render.denoise,
        {"scene", "method", "budget_s", "frame_s", "trace_s", "paths", "Mrays_per_s", "relmse", "relmse_indirect",
         "flip", "bias", "repeats", "reference_relmse", "picture_file", "flip_file", "reference_file"});
    gi::RenderSettings const& s = plan.settings;
    table.facts = {{"size", fmt::format("{}x{}", s.width, s.height)},
                   {"bounces", std::to_string(s.bounces)},
                   {"filter", o.render.denoise + ", included in frame times"},
                   {"threads", s.threads == 0 ? "all" : std::to_string(s.threads)},
                   {"reference", o.reference.empty()
                                     ? fmt::format("path tracing, {} paths per pixel", o.reference_paths)
                                     : describe_reference(o.reference, *plan.reference)}};
    return table;
}

} // namespace

SweepResult run_sweep(SweepOptions const& o)
{
    gi::Report report;
    SweepPlan const plan = plan_sweep(o, report);
    gi::make_folder(o.out);
    SweepResult result{empty_table(o, plan)};
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    Sweep sweep(o, plan, stop, report);
    for (SweepScene const& scene : plan.scenes) {
        std::optional<SweepReference> const reference =
            plan.reference ? keep_reference(*plan.reference, o.out, "reference_" + scene.name)
                           : find_reference(scene, plan.settings, o.reference_paths, o.out, stop, report);
        result.interrupted = !reference || !sweep.run(scene, *reference, result.table);
        if (result.interrupted) break;
    }
    if (result.interrupted) {
        result.table.facts.emplace_back("interrupted", "rows and repeats are missing");
        write(result.table, o.out);
    }
    for (std::string const& note : sweep.notes()) std::fputs(("note: " + note + "\n").c_str(), stderr);
    print_losses(report);
    return result;
}

} // namespace viewer
