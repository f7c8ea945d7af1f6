#include "ar/base/error.h"
#include "gi/base/error.h"
#include "gi/base/file.h"
#include "viewer/ar/ar_window.h"
#include "viewer/ar/runner.h"
#include "viewer/ar/synthesize.h"
#include "viewer/ar/truth.h"
#include "viewer/arguments.h"
#include "viewer/commands.h"
#include "viewer/interrupt.h"
#include "viewer/outputs.h"
#include "viewer/report_json.h"
#include "viewer/validators.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct SynthesizeArguments {
    SynthesizeOptions options;
    std::string folder, size = "640x480";
    bool no_truth = false, no_denoise = false;
};

struct RunArguments {
    std::string session, out, poses, truth, true_poses, frame_table, stats;
    int frames = 0;
    bool fast = false, window = false;
    std::string monitor;
};

int run_synthesize(SynthesizeArguments const& a)
{
    SynthesizeOptions o = a.options;
    o.folder = a.folder;
    auto const [width, height] = parse_size(a.size);
    o.size_px = {width, height};
    o.truth = !a.no_truth;
    o.quality.denoise = !a.no_denoise;
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    int const done = synthesize(o, stop, report);
    fmt::print("{}: {} of {} frames\n", (o.folder / "session.yaml").string(), done, o.frames);
    print_losses(report);
    return stop.requested() ? kInterrupted : 0;
}

/// Composites as numbered pictures.
class PictureFolder {
public:
    explicit PictureFolder(fs::path folder) : folder_(std::move(folder))
    {
        std::error_code problem;
        fs::create_directories(folder_, problem);
        if (problem)
            throw gi::InputError("'" + folder_.string() + "' cannot be made", problem.message(),
                                 "choose another folder");
    }
    void add(std::uint64_t sequence, cv::Mat const& rgb)
    {
        cv::Mat bgr;
        cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
        std::vector<unsigned char> bytes;
        cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
        gi::write_text(folder_ / fmt::format("{:06}.png", sequence),
                       {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
    }

private:
    fs::path folder_;
};

std::string frame_table(ArSummary const& summary)
{
    std::string text =
        "sequence,captured_s,age_ms,decode_ms,detect_ms,pose_ms,light_ms,render_ms,composite_ms,latency_ms,"
        "present_ms,swapped_ms,"
        "markers,points_used,points_rejected,rms_px,confidence,x_m,y_m,z_m,qx,qy,qz,qw,changed_px,clipped_px,"
        "negative_values,not_finite_px\n";
    for (ArFrameRecord const& f : summary.frames) {
        text +=
            fmt::format("{},{:.6f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},"
                        "{:.4f},{:.4f},",
                        f.sequence, f.captured_s, f.age_ms, f.times.decode_ms, f.times.detect_ms, f.times.pose_ms,
                        f.times.light_ms, f.times.render_ms, f.times.composite_ms, f.latency_ms, f.present_ms,
                        f.swapped_ms, f.markers, f.points_used, f.points_rejected, f.rms_px, f.confidence);
        if (f.world_from_camera) {
            ar::Pose const& p = *f.world_from_camera;
            text +=
                fmt::format("{:.7f},{:.7f},{:.7f},{:.8f},{:.8f},{:.8f},{:.8f},", p.position_m.x, p.position_m.y,
                            p.position_m.z, p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w);
        } else {
            text += ",,,,,,,";
        }
        text += fmt::format("{},{},{},{}\n", f.counts.pixels - f.counts.copied, f.counts.clipped,
                            f.counts.negative, f.counts.not_finite);
    }
    return text;
}

/// What is off, frame by frame, against a folder of pictures and the camera's true path.
class Truth {
public:
    explicit Truth(RunArguments const& a) : folder_(a.truth)
    {
        if (!folder_.empty() && !fs::is_directory(folder_))
            throw gi::InputError("there is no folder '" + folder_.string() + "'", "its pictures are the truth",
                                 "name the folder truth that `ar synthesize` made");
        if (!a.true_poses.empty()) poses_ = ar::read_poses(a.true_poses);
    }
    void add(ArFrameRecord const& f, ArResult const& r)
    {
        if (auto const truth = ar::pose_at(poses_, f.captured_s); truth && f.world_from_camera) {
            mm_.push_back(1e3 * glm::length(f.world_from_camera->position_m - truth->position_m));
            deg_.push_back(ar::angle_between_deg(f.world_from_camera->rotation, truth->rotation));
        }
        if (folder_.empty()) return;
        fs::path const file = folder_ / fmt::format("{:06}.png", f.sequence);
        cv::Mat truth = cv::imread(file.string(), cv::IMREAD_COLOR);
        if (truth.empty() || truth.size() != r.rgb.size()) {
            ++missing_;
            return;
        }
        cv::cvtColor(truth, truth, cv::COLOR_BGR2RGB);
        TruthErrors const e = errors_against_truth(r.rgb, r.camera, truth);
        affected_.push_back(e.flip_affected);
        elsewhere_.push_back(e.flip_elsewhere);
        camera_affected_.push_back(e.camera_affected);
        camera_elsewhere_.push_back(e.camera_elsewhere);
        share_.push_back(100 * e.affected);
    }
    std::string text() const
    {
        std::string t;
        auto const line = [&](char const* name, std::vector<double> const& values) {
            if (values.empty()) return;
            Spread const s = spread_of(values);
            t += fmt::format("{:<30} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, s.median, s.p95, s.most);
        };
        line("position error (mm)", mm_);
        line("rotation error (deg)", deg_);
        line("FLIP where it is affected", affected_);
        line("  of adding nothing", camera_affected_);
        line("  share of the picture (%)", share_);
        line("FLIP elsewhere", elsewhere_);
        line("  of adding nothing", camera_elsewhere_);
        if (missing_ > 0) t += fmt::format("no truth of that size: {} frames\n", missing_);
        return t.empty()
                   ? t
                   : fmt::format("{:<30} {:>9} {:>9} {:>9}\n", "against the truth", "median", "95 %", "most") + t;
    }

private:
    fs::path folder_;
    std::vector<ar::TimedPose> poses_;
    std::vector<double> mm_, deg_, affected_, elsewhere_, camera_affected_, camera_elsewhere_, share_;
    int missing_ = 0;
};

/// Nothing that is read may be written over.
void check_arguments(RunArguments const& a, ArSession const& s)
{
    check_outputs({a.frame_table, a.stats},
                  {a.session, a.poses, a.true_poses, s.camera.string(), s.markers.string(), s.light.string(),
                   s.real.scene.string(), s.virtual_things.scene.string()});
    std::error_code ignored;
    for (std::string const& read : {s.frames.source, a.truth})
        if (!a.out.empty() && !read.empty() && fs::equivalent(a.out, read, ignored))
            throw gi::InputError("--out '" + a.out + "' is a folder that is read",
                                 "its pictures would be replaced", "name another folder");
}

int run_session(RunArguments const& a, bool poses_only)
{
    ArSession const session = read_ar_session(a.session);
    check_arguments(a, session);
    ArRunOptions o;
    o.frames = a.frames;
    o.pace = a.fast ? ar::Pace::fastest : ar::Pace::own;
    o.find_poses_only = poses_only;
    if (!a.poses.empty()) o.poses = ar::read_poses(a.poses);
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    std::optional<PictureFolder> folder;
    Truth truth(a);
    std::optional<ArWindow> window;
    if (!a.out.empty()) folder.emplace(a.out);
    auto const look = [&] {
        if (window && window->wants_close()) stop.request();
    };
    o.idle = [&] {
        if (window) window->idle();
        look();
    };
    ArSummary summary;
    auto const keep = [&] {
        if (!a.stats.empty()) gi::write_text(a.stats, to_text(to_json(report)));
        if (!a.frame_table.empty()) gi::write_text(a.frame_table, frame_table(summary));
        fmt::print("{}{}", describe(summary), truth.text());
        print_losses(report);
    };
    auto const shown = [&](ArFrameRecord& f, ArResult const& r) {
        if (a.window && !window) window.emplace(ArWindowSettings{{r.rgb.cols, r.rgb.rows}, a.monitor}, report);
        if (window) window->show(f, r);
        look();
        if (folder) folder->add(f.sequence, r.rgb);
        truth.add(f, r);
    };
    try {
        run_ar(session, o, shown, stop, report, summary);
    } catch (...) {
        if (!summary.frames.empty()) keep();
        throw;
    }
    keep();
    if (summary.end.kind == ar::SourceState::Kind::lost) {
        std::fputs(fmt::format("lightwell: the source was lost: {}\n", summary.end.reason).c_str(), stderr);
        return 1;
    }
    if (summary.frames.empty() && !stop.requested())
        throw gi::InputError("no frame could be used", describe(summary.source), "check the session's frames");
    bool const was_closed = window && window->wants_close();
    return stop.requested() && !was_closed ? kInterrupted : 0;
}

void add_session_options(CLI::App& c, RunArguments& a)
{
    c.add_option("session", a.session, "What is filmed, where the markers are, what is added: see docs/ar.md")
        ->required();
    c.add_option("--frames", a.frames, "At most so many; 0 = all")->check(CLI::NonNegativeNumber);
    c.add_flag("--fast", a.fast, "Files: a frame as soon as the one before is done, not at their own pace");
    c.add_option("--table", a.frame_table, "CSV with a line for each frame: times, pose, counts");
    c.add_option("--stats", a.stats, "JSON: seconds of the renderer's stages, counts, losses");
    c.add_option("--true-poses", a.true_poses, "Where the camera really was (CSV or TUM): the error is told");
}

} // namespace

void add_ar(CLI::App& app, int& exit_code)
{
    CLI::App* const ar = app.add_subcommand("ar", "Augmented reality: virtual things in a camera's pictures");
    ar->require_subcommand(1);
    ar->footer(R"(Examples:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4
  lightwell ar run desk/session.yaml --fast --poses desk/poses.csv --truth desk/truth --out desk/out)");

    auto const made = std::make_shared<SynthesizeArguments>();
    CLI::App* const synthesize = ar->add_subcommand(
        "synthesize",
        "Make a session in which all is known: frames, true poses, probe, pictures with the things there");
    synthesize->add_option("folder", made->folder, "Where its files go")->required();
    synthesize->add_option("--size", made->size, "Of frames, WIDTHxHEIGHT")->capture_default_str();
    synthesize->add_option("--frames", made->options.frames, "How many")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    synthesize->add_option("--paths", made->options.quality.paths, "Of the reference renderer, per pixel")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    synthesize->add_option("--threads", made->options.quality.threads, "0 = all")->check(CLI::NonNegativeNumber);
    synthesize->add_flag("--no-truth", made->no_truth, "Leave out the pictures with the things really there");
    synthesize->add_flag("--no-denoise", made->no_denoise, "Leave frames as noisy as paths are");
    synthesize->footer(R"(Example:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4 --no-truth)");
    synthesize->callback([made, &exit_code] { exit_code = run_synthesize(*made); });

    auto const run = std::make_shared<RunArguments>();
    CLI::App* const run_command = ar->add_subcommand("run", "Add virtual things to frames, live or from files");
    add_session_options(*run_command, *run);
    run_command->add_option("--out", run->out, "Folder for the composites, as PNG");
    run_command->add_option("--poses", run->poses, "Where the camera was (CSV or TUM), in place of its markers");
    run_command->add_flag("--window", run->window, "Show it: S before and after, H panel, Escape ends");
    run_command->add_option("--monitor", run->monitor, "Full screen on the one of this number or name")
        ->needs("--window");
    run_command->add_option("--truth", run->truth,
                            "Folder of pictures with the things really there: FLIP is told");
    run_command->footer(R"(Examples:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4
  lightwell ar run desk/session.yaml --fast --poses desk/poses.csv --table frames.csv --stats stages.json)");
    run_command->callback([run, &exit_code] { exit_code = run_session(*run, false); });

    auto const track = std::make_shared<RunArguments>();
    CLI::App* const track_command =
        ar->add_subcommand("track", "Find the camera in each frame, and how sure that is");
    add_session_options(*track_command, *track);
    track_command->footer(R"(Examples:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4 --no-truth
  lightwell ar track desk/session.yaml --fast --true-poses desk/poses.csv)");
    track_command->callback([track, &exit_code] { exit_code = run_session(*track, true); });

    add_ar_cameras(*ar, exit_code);
    add_ar_record(*ar, exit_code);
    add_ar_replay(*ar, exit_code);
    add_ar_board(*ar, exit_code);
    add_ar_calibrate(*ar, exit_code);
    add_ar_response(*ar, exit_code);
    add_ar_probe(*ar, exit_code);
    add_ar_albedo(*ar, exit_code);
}

} // namespace viewer
