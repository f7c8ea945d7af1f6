#include "ar/capture/frame_source.h"
#include "ar/features/map_builder.h"
#include "ar/runtime/frame_clock.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/quantile.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/camera_view/session_inputs.h"
#include "viewer/cli/ar/ar_camera_path.h"
#include "viewer/cli/ar/ar_outcome.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct MapArguments {
    std::string session, out, require_found;
    PoseArguments poses;
    int frames = 0;
};

FrameTally look(MapArguments const& a, ar::Session const& session, ar::CalibratedCamera const& camera,
                ar::MapBuilder& builder, gi::StopRequest const& stop, gi::Report& report)
{
    CameraPath path(a.poses, session, camera, report);
    ar::OpenOptions open = session.frames.options;
    open.pace = ar::Pace::fastest;
    auto const source = ar::open_source(session.frames.source, open);
    ar::check_size(source->description().size_px, camera);
    if (a.frames == 0 && (source->description().is_live || session.frames.source == "counter"))
        throw gi::InputError("frames of '" + session.frames.source + "', all of them", "the source never ends",
                             "limit their number: --frames 300");
    ar::FrameClock clock(session.frames.source, source->description(), false);
    FrameTally tally;
    gi::ProgressBar bar("map");
    for (int n = 0; !stop.requested() && (a.frames == 0 || n < a.frames);) {
        std::optional<ar::Frame> const frame = source->next(std::chrono::milliseconds(200));
        if (!frame) {
            if (source->state().kind != ar::SourceState::Kind::running) break;
            continue;
        }
        ++n;
        double const time_s = clock(*frame);
        try {
            auto const pose = path.at(*frame, time_s, stop);
            cv::Mat const gray = ar::gray_of(*frame);
            ar::check_size({gray.cols, gray.rows}, camera);
            ++tally.looked_at;
            tally.found += pose.has_value();
            if (pose)
                builder.add(gray, pose->first);
            else
                builder.skip();
        } catch (gi::InputError const& e) {
            ++tally.refused;
            report.lose("frames that could not be used", 1, e.what());
        }
    }
    ar::report_losses(source->counts(), source->state(), report);
    tally.refused += source->counts().refused;
    return tally;
}

std::string describe(ar::FeatureMap const& map, ar::MapBuilderCounts const& c, FrameTally const& t)
{
    std::vector<double> sigma_mm;
    for (ar::MapPoint const& p : map.points) sigma_mm.push_back(1e3 * p.sigma_m);
    std::string text = fmt::format("camera found in {} of {} frames; features looked for in {}\n", t.found,
                                   t.looked_at + t.refused, c.key_pictures);
    text += fmt::format("{} features followed: {} too short, {} seen from one side, {} that fit no point, {} seen "
                        "before\n",
                        c.tracks, c.short_lived, c.no_parallax, c.bad_fit, c.merged);
    if (!map.points.empty())
        text += fmt::format("{} points, standard deviation {:.2f} mm (median), {:.2f} mm (95 %)\n",
                            map.points.size(), gi::quantile(sigma_mm, 0.5), gi::quantile(sigma_mm, 0.95));
    return text;
}

int run_map(MapArguments const& a)
{
    auto const required = parse_share("--require-found", a.require_found);
    ar::Session session = ar::read_session(a.session);
    session.pose.features.clear(); // a map is made from markers, a tracker or a file
    std::vector<std::string> read{a.poses.file};
    for (std::filesystem::path const& file : files_read_by(session)) read.push_back(file.string());
    check_outputs({a.out}, read);
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ar::CalibratedCamera const camera = ar::load_camera(session.camera, &report);
    ar::MapBuilder builder(camera.model);
    FrameTally const tally = look(a, session, camera, builder, stop, report);
    if (stop.requested()) return interrupted_code();
    ar::FeatureMap const& map = builder.finish();
    fmt::print("{}", describe(map, builder.counts(), tally));
    print_losses(report);
    if (map.points.empty())
        return exit_code_of(
            "no map was written (no feature was seen from several sides with a known camera pose) move "
            "the camera around a place with texture");
    ar::check_size(map, "the map");
    gi::write_text(a.out, ar::format_feature_map(map));
    fmt::print("{}\n", a.out);
    return exit_code_of(shortfall(tally, required));
}

} // namespace

void add_ar_map(CLI::App& ar, int& exit_code)
{
    auto const a = std::make_shared<MapArguments>();
    CLI::App* const c = ar.add_subcommand(
        "map", "Make a map of features from a session whose camera poses are known, to track without markers");
    c->add_option("session", a->session, "Session whose frames follow each other, as in a video")->required();
    c->add_option("-o,--out", a->out, "File for the map, for pose.features of sessions")->required();
    declare_poses(*c, a->poses);
    c->add_option("--frames", a->frames, "Read at most this many frames; 0 = all (files only)")
        ->check(CLI::NonNegativeNumber);
    declare_require_found(*c, a->require_found);
    c->footer(R"(Prepared by:
  lightwell ar synthesize mapped --quick --frames 12
Examples:
  lightwell ar map mapped/session.yaml --out map.txt

Then, in the session: pose: {features: map.txt}. Exit code 1: nothing became a point, or as of lightwell ar run.)");
    c->callback([a, &exit_code] { exit_code = run_map(*a); });
}

} // namespace viewer
