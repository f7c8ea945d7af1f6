#include "viewer/bench/pictures.h"

#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/pictures_filtered.h"
#include "viewer/bench/pictures_score.h"
#include "viewer/report/page.h"
#include "viewer/report/picture_summary.h"
#include "viewer/report/table_file.h"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <set>

namespace viewer {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> const kColumns{"scene",
                                        "budget",
                                        "method",
                                        "filter",
                                        "paths",
                                        "render_s",
                                        "structures_s",
                                        "paths_s",
                                        "filter_s",
                                        "total_s",
                                        "relmse",
                                        "relmse_estimated",
                                        "relmse_of_reference",
                                        "flip",
                                        "bias",
                                        "bias_error",
                                        "bias_direct",
                                        "bias_direct_error",
                                        "bias_indirect",
                                        "bias_indirect_error",
                                        "neighbour_correlation",
                                        "repeats",
                                        "picture_file",
                                        "flip_file",
                                        "reference_file"};

/// Samples of all repeats of a method with a budget.
struct RenderSamples {
    std::vector<double> paths, render_s, structures_s, paths_s, estimated;
};
/// Samples of these renders through one filter.
struct FilterSamples {
    std::vector<double> filter_s, total_s, relmse, flip, correlation;
    std::array<std::vector<double>, 3> bias;
    PictureFiles files;
};
struct MethodSamples {
    RenderSamples render;
    std::vector<FilterSamples> filtered;
};

/// One scene with its reference.
struct PictureScene {
    SweepScene scene;
    SweepReference reference;
    std::array<double, 3> bias_errors{};
};

Cell median_of(std::vector<double> const& values)
{
    std::vector<double> finite;
    for (double const v : values)
        if (std::isfinite(v)) finite.push_back(v);
    return finite.empty() ? Cell() : Cell(summarise(finite));
}

class Pictures {
public:
    Pictures(PicturesOptions const& o, PicturesPlan const& plan, gi::StopRequest const& stop, gi::Report& report,
             BenchTable& table)
        : o_(o), plan_(plan), stop_(stop), report_(report), table_(table)
    {
    }

    /// @return false if it was interrupted
    bool run(ListedScene const& listed);
    std::set<std::string> const& notes() const { return notes_; }

private:
    bool is_done(std::string const& scene, PictureBudget const& budget) const;
    bool is_done(std::string const& scene) const;
    gi::RenderSettings settings(SweepMethod const& method, PictureBudget const& budget, int repeat) const;
    void warm_up(PictureScene const& s);
    bool measure_budget(PictureScene const& s, PictureBudget const& budget);
    bool measure(PictureScene const& s, SweepMethod const& method, PictureBudget const& budget, int repeat,
                 MethodSamples& into);
    void judge(PictureScene const& s, SweepMethod const& method, PictureBudget const& budget, int repeat,
               gi::RenderResult const& result, double render_s, MethodSamples& into);
    void add_rows(PictureScene const& s, PictureBudget const& budget, SweepMethod const& method,
                  MethodSamples const& samples);

    PicturesOptions const& o_;
    PicturesPlan const& plan_;
    gi::StopRequest const& stop_;
    gi::Report& report_;
    BenchTable& table_;
    std::set<std::string> notes_;
};

bool Pictures::is_done(std::string const& scene, PictureBudget const& budget) const
{
    auto const has_row = [&](std::string const& method, std::string const& filter) {
        return std::ranges::any_of(table_.rows, [&](auto const& row) {
            auto const is = [&](char const* column, std::string const& value) {
                return to_text(cell(table_, row, column)) == value;
            };
            return is("scene", scene) && is("budget", budget.name) && is("method", method) && is("filter", filter);
        });
    };
    for (SweepMethod const& m : plan_.methods)
        for (PictureFilter const& f : plan_.filters)
            if (!has_row(m.name, f.name)) return false;
    return true;
}

bool Pictures::is_done(std::string const& scene) const
{
    return std::ranges::all_of(plan_.budgets, [&](PictureBudget const& b) { return is_done(scene, b); });
}

gi::RenderSettings Pictures::settings(SweepMethod const& method, PictureBudget const& budget, int repeat) const
{
    gi::RenderSettings s = settings_of(method, plan_.settings);
    s.budget_s = budget.seconds;
    if (budget.paths > 0) s.paths = budget.paths;
    s.seed = plan_.settings.seed + std::uint64_t(repeat);
    return s;
}

/// Renders and filters once without measuring: the first calls also start threads and fill caches.
void Pictures::warm_up(PictureScene const& s)
{
    gi::Report unused;
    for (SweepMethod const& m : plan_.methods) {
        if (stop_.requested()) return;
        gi::RenderResult const result =
            m.method.render(s.scene.world, s.scene.camera, settings(m, {"", 0, 2}, 0), stop_, {}, unused);
        for (PictureFilter const& f : plan_.filters) filtered(result.picture, f);
    }
}

bool Pictures::run(ListedScene const& listed)
{
    if (is_done(listed.name)) return true;
    PictureScene s;
    try {
        s.scene = load_sweep_scene(listed.options, listed.name, report_);
    } catch (gi::InputError const& e) {
        skip({"scene " + listed.name, e.what()}, table_);
        return true;
    }
    fs::path const references = reference_folder(o_);
    std::optional<SweepReference> found = find_reference(s.scene, plan_.settings, o_.reference_paths, references,
                                                         stop_, report_, ReferenceOf::any_program);
    if (!found) return false;
    s.reference = keep_reference(std::move(found->picture), o_.out, "reference_" + listed.name);
    s.bias_errors = bias_errors(s.reference.picture);
    warm_up(s);
    for (PictureBudget const& budget : plan_.budgets) {
        if (is_done(listed.name, budget)) continue;
        if (!measure_budget(s, budget)) return false;
    }
    return true;
}

bool Pictures::measure_budget(PictureScene const& s, PictureBudget const& budget)
{
    std::size_t const n = plan_.methods.size();
    std::vector<MethodSamples> samples(n);
    for (MethodSamples& m : samples) m.filtered.resize(plan_.filters.size());
    gi::ProgressBar bar("pictures", !o_.render.quiet);
    // In turns, so that a slower machine affects all methods equally.
    for (int repeat = 0; repeat < o_.repeats; ++repeat)
        for (std::size_t i = 0; i < n; ++i) {
            std::size_t const m = (std::size_t(repeat) + i) % n;
            if (stop_.requested()) return false;
            bar.update((repeat + double(i) / double(n)) / o_.repeats,
                       fmt::format("{}, {}, {}", s.scene.name, budget.name, plan_.methods[m].name));
            if (!measure(s, plan_.methods[m], budget, repeat, samples[m])) return false;
        }
    for (std::size_t m = 0; m < n; ++m) add_rows(s, budget, plan_.methods[m], samples[m]);
    write(table_, o_.out);
    return true;
}

bool Pictures::measure(PictureScene const& s, SweepMethod const& method, PictureBudget const& budget, int repeat,
                       MethodSamples& into)
{
    gi::Report report;
    gi::RenderSettings const set = settings(method, budget, repeat);
    gi::RenderResult result;
    double const render_s =
        seconds_of([&] { result = method.method.render(s.scene.world, s.scene.camera, set, stop_, {}, report); });
    for (auto const& [what, loss] : report.losses())
        report_.lose(what, loss.count, s.scene.name + (loss.first.empty() ? "" : ", " + loss.first));
    if (result.end == gi::RenderEnd::interrupted) return false;
    RenderSeconds const parts = seconds_by_part(report);
    RenderSamples& r = into.render;
    r.paths.push_back(result.paths);
    r.render_s.push_back(render_s);
    r.structures_s.push_back(parts.structures);
    r.paths_s.push_back(parts.paths);
    // One path gives no variance.
    r.estimated.push_back(result.paths > 1 ? result.relmse : std::nan(""));
    judge(s, method, budget, repeat, result, render_s, into);
    return true;
}

void Pictures::judge(PictureScene const& s, SweepMethod const& method, PictureBudget const& budget, int repeat,
                     gi::RenderResult const& result, double render_s, MethodSamples& into)
{
    for (std::size_t f = 0; f < plan_.filters.size(); ++f) {
        PictureFilter const& filter = plan_.filters[f];
        FilterSamples& to = into.filtered[f];
        FilteredPicture const done = filtered(result.picture, filter);
        if (done.no_variance)
            notes_.insert(
                fmt::format("--denoise {} changes nothing of {} with budget {}: the picture has no variance",
                            filter.name, method.name, budget.name));
        PictureScore const judged = score(done.picture, s.reference);
        to.filter_s.push_back(done.seconds);
        to.total_s.push_back(render_s + done.seconds);
        to.relmse.push_back(judged.relmse);
        to.flip.push_back(judged.flip);
        to.correlation.push_back(judged.neighbour_correlation);
        for (std::size_t k = 0; k < to.bias.size(); ++k) to.bias[k].push_back(judged.bias[k]);
        if (repeat > 0) continue;
        to.files = save_pictures(done.picture, s.reference, o_.out,
                                 picture_stem(s.scene.name, method.name, budget.name) + "_" + filter.name);
    }
}

void Pictures::add_rows(PictureScene const& s, PictureBudget const& budget, SweepMethod const& method,
                        MethodSamples const& samples)
{
    // Removes rows of an earlier, unfinished run.
    std::erase_if(table_.rows, [&](auto const& row) {
        auto const is = [&](char const* column, std::string const& value) {
            return to_text(cell(table_, row, column)) == value;
        };
        return is("scene", s.scene.name) && is("budget", budget.name) && is("method", method.name);
    });
    RenderSamples const& r = samples.render;
    for (std::size_t f = 0; f < plan_.filters.size(); ++f) {
        FilterSamples const& p = samples.filtered[f];
        std::array<MeanOf, 3> bias;
        for (std::size_t k = 0; k < bias.size(); ++k) bias[k] = mean_of(p.bias[k], s.bias_errors[k]);
        table_.add({s.scene.name,
                    budget.name,
                    method.name,
                    plan_.filters[f].name,
                    median_of(r.paths),
                    median_of(r.render_s),
                    median_of(r.structures_s),
                    median_of(r.paths_s),
                    median_of(p.filter_s),
                    median_of(p.total_s),
                    median_of(p.relmse),
                    median_of(r.estimated),
                    s.reference.relmse,
                    median_of(p.flip),
                    bias[0].value,
                    bias[0].error,
                    bias[1].value,
                    bias[1].error,
                    bias[2].value,
                    bias[2].error,
                    median_of(p.correlation),
                    double(o_.repeats),
                    p.files.picture,
                    p.files.flip_map,
                    s.reference.png_file});
    }
}

BenchTable start_pictures(PicturesOptions const& o, PicturesPlan const& plan)
{
    BenchTable table = start_table("pictures", "Methods by their pictures", kColumns);
    table.facts = common_facts(o, plan);
    fs::path const file = fs::path(o.out) / "pictures.json";
    if (!o.resume || !fs::exists(file)) return table;
    constexpr std::size_t kMostBytes = std::size_t(1) << 28;
    std::vector<unsigned char> const bytes = gi::read_bytes(file, kMostBytes);
    BenchTable earlier = parse_table(std::string(bytes.begin(), bytes.end()), file.string());
    auto const refuse = [&](std::string const& why) {
        return gi::InputError("--resume: '" + file.string() + "' is from another run", why,
                              "choose another --out, or leave --resume out");
    };
    if (earlier.columns != table.columns) throw refuse("it has other columns");
    if (earlier.program != table.program) throw refuse("it was made by " + earlier.program);
    for (auto const& fact : table.facts)
        if (std::ranges::find(earlier.facts, fact) == earlier.facts.end())
            throw refuse("its " + fact.first + " differs");
    table.rows = std::move(earlier.rows);
    return table;
}

/// Pictures are linked, not embedded, as there may be a thousand.
void write_page(PicturesOptions const& o, PicturesResult const& result)
{
    Page page;
    page.title = "Lightwell bench pictures";
    page.pictures = PagePictures::linked;
    page.folders.push_back({o.out, {result.summary, result.pictures}, {}});
    gi::write_text(fs::path(o.out) / "pictures.html", make_page(page));
}

} // namespace

BenchTable summary_of(BenchTable const& pictures)
{
    BenchTable summary = start_table("pictures_summary", fmt::format("Against {}, worst first", kPeer),
                                     picture_summary_columns(kPeer));
    summary.facts = pictures.facts;
    fill_picture_summary(contests(pictures, kPeer), kPeer, summary);
    return summary;
}

PicturesResult run_pictures(PicturesOptions const& o)
{
    PicturesPlan const plan = plan_pictures(o);
    PicturesResult result{start_pictures(o, plan), {}, false};
    gi::make_folder(o.out);
    for (Skipped const& s : plan.skipped) skip(s, result.pictures);
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    Pictures pictures(o, plan, stop, report, result.pictures);
    for (ListedScene const& scene : plan.scenes) {
        result.interrupted = !pictures.run(scene);
        if (result.interrupted) break;
        result.summary = summary_of(result.pictures);
        write(result.summary, o.out);
        write_page(o, result);
    }
    if (result.interrupted) result.pictures.facts.emplace_back("interrupted", "rows are missing");
    write(result.pictures, o.out);
    result.summary = summary_of(result.pictures);
    write(result.summary, o.out);
    write_page(o, result);
    for (std::string const& note : pictures.notes()) std::fputs(("note: " + note + "\n").c_str(), stderr);
    print_losses(report);
    return result;
}

} // namespace viewer
