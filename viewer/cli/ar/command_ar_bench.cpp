#include "ar/camera/photometry.h"
#include "ar/capture/clock.h"
#include "ar/composite/rendered_pair.h"
#include "ar/markers/aruco.h"
#include "ar/markers/marker_map_file.h"
#include "ar/pipeline/synthesize.h"
#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "viewer/base/arguments.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/bench/bench_record.h"
#include "viewer/camera_view/measured_run.h"
#include "viewer/cli/ar/ar_chain_check.h"
#include "viewer/cli/ar/ar_light_bench.h"
#include "viewer/cli/ar/ar_outcome.h"
#include "viewer/cli/commands.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <opencv2/core.hpp>

namespace viewer {
namespace {

/// The compositing equation written directly with OpenCV, one whole picture per step, to compare with: with + (1 - a)(camera -
/// without), for a camera with sRGB bytes: decoded by table, encoded by powers.
/// @param rgb CV_8UC3
cv::Mat plain_composite(cv::Mat const& rgb, ar::RenderedPair const& pair)
{
    ar::Photometry const srgb = ar::srgb_photometry();
    cv::Mat const table(1, 256, CV_32FC1, const_cast<float*>(srgb.unit_of_byte[0].data()));
    cv::Mat light, uncovered, dark, bright;
    cv::LUT(rgb, table, light);
    cv::subtract(light, pair.without, light);
    cv::subtract(1, pair.coverage, uncovered);
    cv::merge(std::vector<cv::Mat>(3, uncovered), uncovered);
    cv::multiply(light, uncovered, light);
    cv::add(light, pair.with, light);
    light = cv::max(light, 0);
    cv::pow(light, 1 / 2.4, bright);
    bright.convertTo(bright, -1, 255 * 1.055, -255 * 0.055);
    light.convertTo(dark, -1, 255 * 12.92);
    dark.copyTo(bright, light <= 0.0031308);
    cv::Mat out;
    bright.convertTo(out, CV_8U);
    return out;
}

namespace fs = std::filesystem;

struct BenchArguments {
    std::string session, folder, out, require_found;
    std::vector<std::string> sizes{"640x480", "1280x720"};
    std::vector<std::uint32_t> paths{1, 2, 4};
    std::vector<double> resolutions{0.5};
    std::vector<std::string> lights{"prefiltered", "paths"};
    int frames = 20, still_frames = 16;
    std::uint32_t truth_paths = 8;
    bool counter = false, window = false, json = false;
    LightBenchSettings light_check;
};

std::string size_text(glm::ivec2 px) { return fmt::format("{}x{}", px.x, px.y); }

/// Session of a synthetic desk, created if it does not exist and kept for later runs.
fs::path synthetic_session(BenchArguments const& a, glm::ivec2 size_px, gi::StopRequest const& stop,
                           gi::Report& report)
{
    ar::SynthesizeOptions o;
    fs::path const all = a.folder.empty() ? fs::temp_directory_path() / "lightwell_ar_bench" : fs::path(a.folder);
    o.folder = all / fmt::format("desk {} {} frames {} paths", size_text(size_px), a.frames, a.truth_paths);
    o.size_px = size_px;
    o.frames = a.frames;
    o.truth = a.truth_paths > 0;
    o.quality.paths = std::max(a.truth_paths, 2u);
    ar::synthesize(o, stop, report);
    return o.folder / "session.yaml";
}

Cell cell_of(std::vector<double> const& values) { return values.empty() ? Cell() : Cell(summarise(values)); }

std::vector<double> values_of(std::vector<ar::RunFrame> const& frames, double (*value)(ar::RunFrame const&))
{
    std::vector<double> values;
    for (ar::RunFrame const& f : frames) values.push_back(value(f));
    return values;
}

/// Frames with a trusted pose of their own; empty without frames.
Cell found_percent(std::vector<ar::RunFrame> const& frames)
{
    return frames.empty() ? Cell() : Cell(100 * double(ar::count_found(frames)) / double(frames.size()));
}

/// Median, 95th percentile and maximum of each stage.
void add_stages(BenchTable& table, std::string const& size, std::string const& light, double paths,
                double resolution, std::string const& pace, std::vector<ar::RunFrame> const& frames)
{
    using Record = ar::RunFrame const&;
    std::pair<char const*, double (*)(Record)> const stages[] = {
        {"read", [](Record f) { return f.read_ms; }},
        {"age when handed over", [](Record f) { return f.age_ms; }},
        {"decode", [](Record f) { return f.times.decode_ms; }},
        {"detect", [](Record f) { return f.times.detect_ms; }},
        {"pose", [](Record f) { return f.times.pose_ms; }},
        {"wait to be rendered", [](Record f) { return f.times.wait_ms; }},
        {"light", [](Record f) { return f.times.light_ms; }},
        {"render", [](Record f) { return f.times.render_ms; }},
        {"composite", [](Record f) { return f.times.composite_ms; }},
        {"wait to be shown", [](Record f) { return f.show_wait_ms; }},
        {"present", [](Record f) { return f.present_ms; }},
        {"capture to result", [](Record f) { return f.latency_ms; }},
        {"capture to swap", [](Record f) { return f.swapped_ms; }},
    };
    for (auto const& [name, value] : stages) {
        ar::Spread const s = ar::spread_of(values_of(frames, value));
        if (s.most > 0)
            table.add({size, light, paths, resolution, pace, std::string(name), s.median, s.p95, s.most});
    }
}

/// Share of marker detection that the library's search (OpenCV or apriltag) takes, measured in the same rounds.
Cell share_of_search(ar::Session const& session, ar::FrameResult const& last)
{
    ar::MarkerMap const map = ar::read_marker_map(session.markers);
    if (last.camera.empty()) return {};
    ar::Frame frame;
    frame.size_px = {last.camera.cols, last.camera.rows};
    frame.planes[0] = ar::eight_bits_of(last.camera);
    cv::Mat const gray = ar::gray_of(frame);
    ar::SearchSettings plain = ar::search_settings({}, gray.size());
    plain.refinement = ar::Refinement::none;
    std::vector<std::string> dictionaries;
    for (ar::PlacedMarker const& m : ar::placed_markers(map))
        if (std::find(dictionaries.begin(), dictionaries.end(), m.dictionary) == dictionaries.end())
            dictionaries.push_back(m.dictionary);
    auto const times = measure_interleaved(7, {[&] { ar::detect(gray, map); },
                                               [&] {
                                                   for (std::string const& d : dictionaries)
                                                       ar::find_markers(gray, d, plain);
                                               }});
    return ratio(times[1], times[0]);
}

/// Time of compositing by plain OpenCV relative to ours, in the same rounds, and their mean difference in byte
/// values. Only for frames of sRGB bytes.
std::pair<Cell, Cell> plain_over_ours(MeasuredRun const& m)
{
    if (!m.last.pair || !m.compositor) return {};
    ar::Photometry const &p = m.compositor->photometry(), srgb = ar::srgb_photometry();
    if (p.unit_of_byte != srgb.unit_of_byte || p.vignetting != srgb.vignetting || p.colour != srgb.colour ||
        p.radiance_per_unit != 1 || m.last.camera.depth() != CV_8U)
        return {};
    ar::Compositor compositor(p); // without noise, so that differences are comparable
    cv::Mat ours, plain, difference;
    auto const times = measure_interleaved(7, {[&] { compositor(m.last.camera, *m.last.pair, {}, ours); },
                                               [&] { plain = plain_composite(m.last.camera, *m.last.pair); }});
    cv::absdiff(ours, plain, difference);
    cv::Scalar const mean = cv::mean(difference);
    return {ratio(times[1], times[0]), (mean[0] + mean[1] + mean[2]) / 3};
}

void measure(BenchArguments const& a, ar::Session session, MeasureSettings const& settings, bool given,
             BenchTable& table, BenchTable& stages, BenchTable& curve, FrameTally& tally, gi::StopRequest& stop,
             gi::Report& report)
{
    std::string const size = size_text(ar::load_camera(session.camera).model.size_px);
    auto const one = [&](ar::PairLight light, std::uint32_t most_paths, std::optional<double> rendered) {
        session.render.light = light;
        session.render.paths = most_paths;
        session.render.resolution = rendered;
        MeasuredRun const m = measure_run(session, settings, stop, report);
        if (stop.requested()) {
            if (m.fast.empty() && m.own.empty()) return;
            table.facts.emplace_back("ended early", fmt::format("{}, {} paths", size, most_paths));
        }
        tally.looked_at += m.fast.size();
        tally.found += ar::count_found(m.fast);
        tally.refused += m.refused;
        bool const swapped = settings.in_window;
        auto const [plain, bytes] = plain_over_ours(m);
        std::string const by = m.is_prefiltered ? "prefiltered" : "paths";
        double const paths = m.is_prefiltered ? 0 : double(most_paths);
        double const resolution = ar::resolution_of(session.render, m.is_prefiltered);
        table.add({size, by, paths, resolution, m.frames_per_s, found_percent(m.fast),
                   cell_of(values_of(
                       m.own, swapped ? [](ar::RunFrame const& f) { return f.swapped_ms; }
                                      : [](ar::RunFrame const& f) { return f.latency_ms; })),
                   double(m.own.size()), double(m.overtaken), cell_of(m.errors.flip_affected),
                   cell_of(m.errors.camera_affected), cell_of(m.errors.flip_elsewhere),
                   cell_of(m.flicker.blocks_percent), m.flicker.frames > 1 ? Cell(m.flicker.bytes) : Cell(),
                   cell_of(m.errors.position_mm), cell_of(m.errors.rotation_deg), share_of_search(session, m.last),
                   plain, bytes});
        for (ar::ConfidenceBin const& b : ar::confidence_curve(m.errors.poses.estimates()))
            if (b.frames > 0)
                curve.add({size, by, paths, resolution, b.low, b.high, double(b.frames), b.median_mm, b.p95_mm,
                           b.median_deg, b.p95_deg});
        add_stages(stages, size, by, paths, resolution, "fast", m.fast);
        add_stages(stages, size, by, paths, resolution, "own", m.own);
        if (m.refused > 0) table.facts.emplace_back("frames refused, " + size, fmt::format("{}", m.refused));
    };
    if (given) return one(session.render.light, session.render.paths, session.render.resolution);
    struct Quality {
        ar::PairLight light;
        std::uint32_t paths;
        double resolution;
    };
    std::vector<Quality> qualities;
    for (std::string const& light : a.lights)
        for (std::uint32_t const paths : light == "paths" ? a.paths : std::vector<std::uint32_t>{1})
            for (double const resolution : a.resolutions)
                qualities.push_back(
                    {light == "paths" ? ar::PairLight::paths : ar::PairLight::prefiltered, paths, resolution});
    for (std::size_t k = 0; k < qualities.size(); ++k) {
        if (stop.requested()) return;
        double const begun_s = ar::steady_now_s();
        one(qualities[k].light, qualities[k].paths, qualities[k].resolution);
        if (double const each_s = ar::steady_now_s() - begun_s; k == 0)
            gi::say_estimate("bench of " + size, each_s * double(qualities.size() - 1),
                             fmt::format("{} further qualities as long as the first: {:.1f} s each",
                                         qualities.size() - 1, each_s));
    }
}

void keep(std::vector<BenchTable*> const& tables, BenchArguments const& a)
{
    std::string json;
    for (BenchTable* const t : tables) {
        if (!a.out.empty()) write(*t, a.out);
        json += fmt::format("{}\"{}\": {}", json.empty() ? "{" : ", ", t->name, to_json(*t));
        if (a.json) continue;
        print(*t);
        if (!a.out.empty()) fmt::print("{}\n", (fs::path(a.out) / (t->name + ".json")).string());
    }
    if (a.json) fmt::print("{}}}\n", json);
}

int run_bench(BenchArguments const& a)
{
    auto const required = parse_share("--require-found", a.require_found);
    FrameTally tally;
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    char const* const latency = a.window ? "capture_to_swap_ms" : "capture_to_result_ms";
    BenchTable table =
        start_table("ar", "Frames per second and latency of augmented reality, with the error",
                    {"size", "light", "paths", "resolution", "fast_frames_per_s", "found_percent", latency,
                     "own_frames", "own_overtaken", "flip_affected", "flip_of_adding_nothing", "flip_elsewhere",
                     "flicker_percent", "flicker_bytes", "position_mm", "rotation_deg", "search_share_of_detect",
                     "plain_opencv_over_composite", "plain_opencv_differs_bytes"});
    BenchTable stages =
        start_table("ar_stages", "Stages of a frame",
                    {"size", "light", "paths", "resolution", "pace", "stage", "median_ms", "p95_ms", "most_ms"});
    BenchTable curve =
        start_table("ar_confidence", "Errors of estimated camera poses by their confidence",
                    {"size", "light", "paths", "resolution", "confidence_low", "confidence_high", "frames",
                     "position_median_mm", "position_p95_mm", "rotation_median_deg", "rotation_p95_deg"});
    if (!a.window)
        table.facts.emplace_back("latency", "without a window: until the composite is ready, not shown");
    table.facts.emplace_back("first frames", "left out: they build lasting structures");
    if (!a.session.empty()) {
        ar::Session const session = ar::read_session(a.session);
        fs::path const folder = fs::path(a.session).parent_path();
        MeasureSettings settings{a.frames, {}, {}, a.window, a.still_frames};
        if (fs::is_directory(folder / "truth")) settings.truth = folder / "truth";
        if (fs::exists(folder / "poses.csv")) settings.true_poses = folder / "poses.csv";
        measure(a, session, settings, true, table, stages, curve, tally, stop, report);
    } else {
        for (std::string const& size : a.sizes) {
            auto const [width, height] = parse_size(size);
            fs::path const file = synthetic_session(a, {width, height}, stop, report);
            if (stop.requested()) break;
            MeasureSettings settings{a.frames, {}, file.parent_path() / "poses.csv", a.window, a.still_frames};
            if (a.truth_paths > 0) settings.truth = file.parent_path() / "truth";
            measure(a, ar::read_session(file), settings, false, table, stages, curve, tally, stop, report);
            if (stop.requested()) break;
        }
        table.facts.emplace_back("paths of frames and truth", fmt::format("{}", std::max(a.truth_paths, 2u)));
    }
    keep({&stages, &curve, &table}, a);
    print_losses(report);
    return stop.requested() ? interrupted_code() : exit_code_of(shortfall(tally, required));
}

int run_counter(BenchArguments const& a)
{
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ChainChecked checked = check_chain({a.sizes, a.frames, a.window}, stop, report);
    keep({&checked.table}, a);
    print_losses(report);
    if (stop.requested()) return interrupted_code();
    if (!checked.good) std::fputs("lightwell: what was shown does not match the records\n", stderr);
    return checked.good ? 0 : 1;
}

int run_light_check(BenchArguments const& a)
{
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    BenchTable table = measure_light_estimates(a.light_check, stop, report);
    keep({&table}, a);
    print_losses(report);
    return stop.requested() ? interrupted_code() : 0;
}

int run(BenchArguments const& a)
{
    if (!a.out.empty()) {
        check_folder(a.out);
        gi::make_folder(a.out);
    }
    if (!a.light_check.maps.empty()) return run_light_check(a);
    return a.counter ? run_counter(a) : run_bench(a);
}

} // namespace

void add_ar_bench(CLI::App& ar, int& exit_code)
{
    auto const a = std::make_shared<BenchArguments>();
    CLI::App* const c =
        ar.add_subcommand("bench", "Measure frames per second, latency from capture to display, and the error");
    CLI::Option* const session = c->add_option(
        "session", a->session, "Session as for run, with its own quality (default: generated desk sessions)");
    c->add_option("--size", a->sizes, "Frame size, WIDTHxHEIGHT; repeatable")
        ->take_all()
        ->excludes(session)
        ->capture_default_str();
    c->add_option("--light", a->lights, "How virtual objects are lit: prefiltered, paths; comma-separated")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"prefiltered", "paths"}))
        ->excludes(session)
        ->capture_default_str();
    c->add_option("--paths", a->paths, "Paths per rendered pixel and side, comma-separated")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 1024))
        ->excludes(session)
        ->capture_default_str();
    c->add_option("--resolution", a->resolutions, "Rendered pixels per pixel of the camera, comma-separated")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(in_range(0.05, 4))
        ->excludes(session)
        ->capture_default_str();
    c->add_option("--frames", a->frames, "Frames of each desk or session; with --counter: frames to show")
        ->check(CLI::Range(2, 100000))
        ->capture_default_str();
    c->add_option("--still-frames", a->still_frames,
                  "Times that the first frame is shown again to measure flicker; below 2: not measured")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    c->add_option("--truth-paths", a->truth_paths,
                  "Paths per pixel of the desks' frames and reference pictures; 0 = no reference pictures")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    c->add_option("--folder", a->folder, "Folder that keeps desks for later runs (default: the temporary folder)");
    declare_require_found(*c, a->require_found);
    c->add_flag("--window", a->window, "Show the frames at the camera's pace in a window: latency until the swap");
    c->add_flag("--counter", a->counter,
                "Instead, check that shown frames and rendering match: frames show their number, and a ball "
                "moves with the camera. Exit code 1 if they do not");
    CLI::Option* const maps =
        c->add_option("--light-maps", a->light_check.maps,
                      "Instead, check ar light: render the desk (320 x 240) under each of these environment maps, "
                      "estimate its light from the frame, compare")
            ->excludes(session);
    c->add_option("--light-views", a->light_check.views, "Frames that the light is estimated from")
        ->check(CLI::Range(1, 20))
        ->needs(maps)
        ->capture_default_str();
    c->add_option("--light-paths", a->light_check.paths, "Paths per pixel of these frames")
        ->check(CLI::Range(1, 100000))
        ->needs(maps)
        ->capture_default_str();
    c->add_flag("--light-albedo-unknown", a->light_check.unknown_albedo,
                "Only the albedo of the paper is known, not that of table and things")
        ->needs(maps);
    c->add_option("-o,--out", a->out, "Folder for the tables, as JSON and CSV");
    c->add_flag("--json", a->json, "Print the tables as JSON, in one object by their names");
    c->footer(R"(Examples:
  lightwell ar bench --size 640x480 --frames 2 --paths 1 --truth-paths 2 --folder desks --out table
  lightwell ar bench --counter --size 320x240 --frames 10

Each quality is run twice: as fast as possible (frames per second, error; no frame is skipped) and at the camera's
own pace of 30 Hz (latency; frames overtaken by newer ones are counted). Then the first frame is composited again and
again, with nothing moving: flicker_percent is the standard deviation of the mean radiance of blocks of 8 x 8 pixels on
virtual objects, in per cent of it (median over blocks and their range), flicker_bytes that of bytes. The same rounds also measure the share
of the library's search (OpenCV or apriltag) in marker detection, and the time of compositing by plain OpenCV, one
whole picture per step, relative to ours. Exit code 1 as of lightwell ar run.)");
    c->callback([a, &exit_code] { exit_code = run(*a); });
}

} // namespace viewer
