#include "ar/calibration/calibration_file.h"
#include "ar/capture/clock.h"
#include "ar/capture/libcamera_source.h"
#include "ar/capture/session_writer.h"
#include "gi/core/error.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

int run_cameras(bool json)
{
    std::vector<ar::CameraEntry> const cameras = ar::list_cameras();
    if (json) {
        nlohmann::ordered_json j;
        j["libcamera"] = ar::libcamera_version();
        j["cameras"] = nlohmann::ordered_json::array();
        for (ar::CameraEntry const& c : cameras) j["cameras"].push_back({{"id", c.id}, {"name", c.name}});
        fmt::print("{}", to_text(j));
        return 0;
    }
    for (ar::CameraEntry const& c : cameras) fmt::print("camera:{}  {}\n", c.id, c.name);
    if (cameras.empty())
        fmt::print("libcamera {} finds no camera; a V4L2 camera may still be available as device:0\n",
                   ar::libcamera_version());
    return 0;
}

struct RecordOptions {
    SourceArguments source;
    std::string out, calibration, note;
    std::uint64_t frames = 0;
    double seconds = 0;
    bool json = false;
};

/// Throws if the calibration is for another picture size and so useless for the session.
void check_calibration(RecordOptions const& o, ar::SourceDescription const& camera)
{
    if (o.calibration.empty()) return;
    glm::ivec2 const is = camera.size_px, was = ar::read_calibration(o.calibration, is).camera.size_px;
    if (is != was)
        throw gi::InputError(fmt::format("{} is for pictures of {} x {} px", o.calibration, was.x, was.y),
                             fmt::format("{} gives {} x {}", o.source.source, is.x, is.y),
                             "record at that size, or without --calibration");
}

struct Recorded {
    std::uint64_t offered = 0;
    double seconds = 0;
    bool limit_reached = false;
};

Recorded record(ar::FrameSource& source, ar::SessionWriter& writer, RecordOptions const& o,
                gi::StopRequest const& stop)
{
    Recorded r;
    gi::ProgressBar bar("record " + o.source.source);
    double const start_s = ar::steady_now_s();
    while (!stop.requested() && writer.failure().empty()) {
        r.seconds = ar::steady_now_s() - start_s;
        r.limit_reached = (o.frames > 0 && r.offered >= o.frames) || (o.seconds > 0 && r.seconds >= o.seconds);
        if (r.limit_reached) break;
        bar.update(std::max(o.frames > 0 ? double(r.offered) / double(o.frames) : 0,
                            o.seconds > 0 ? r.seconds / o.seconds : 0),
                   describe(source.counts()));
        auto const frame = source.next(std::chrono::milliseconds(100));
        if (frame) {
            writer.append(*frame);
            ++r.offered;
        } else if (source.state().kind != ar::SourceState::Kind::running) {
            break;
        }
    }
    return r;
}

int run_record(RecordOptions const& o)
{
    auto const source = open(o.source, ar::Pace::own, ar::Delivery::every);
    ar::SessionHeader header;
    header.camera = source->description();
    header.calibration = o.calibration;
    header.note = o.note;
    check_calibration(o, header.camera);
    ar::SessionWriter writer(o.out, header);
    if (ar::Controls const c = controls_of(o.source); c != ar::Controls{}) writer.append(c);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    Recorded const r = record(*source, writer, o, stop);
    writer.finish();
    ar::SourceCounts const counts = source->counts();
    ar::SourceState const end = source->state();
    if (o.json) {
        nlohmann::ordered_json j;
        j["session"] = o.out;
        j["camera"] = header.camera.name;
        j["size_px"] = {header.camera.size_px.x, header.camera.size_px.y};
        j["format"] = name_of(header.camera.format);
        j["frames"] = writer.written();
        j["seconds"] = r.seconds;
        j["dropped"] = counts.dropped;
        j["refused"] = counts.refused;
        j["last_refusal"] = counts.last_refusal;
        j["changed"] = counts.changed;
        j["last_change"] = counts.last_change;
        j["lost_by_queue"] = writer.lost();
        j["failure"] = writer.failure();
        fmt::print("{}", to_text(j));
    } else {
        fmt::print("{}: {} frames in {:.2f} s, {} x {} px, {}; {} lost by the queue to the disk\n", o.out,
                   writer.written(), r.seconds, header.camera.size_px.x, header.camera.size_px.y,
                   name_of(header.camera.format), writer.lost());
        fmt::print("{}: {}\n", header.camera.name, describe(counts));
    }
    if (!writer.failure().empty())
        fmt::print(stderr, "lightwell: '{}' was cut off ({}) frames written before can be played\n", o.out,
                   writer.failure());
    bool const broke_off = end.kind == ar::SourceState::Kind::lost;
    if (broke_off)
        fmt::print(stderr, "lightwell: {} broke off ({}) frames received before were kept\n", o.source.source,
                   end.reason);
    if (broke_off || !writer.failure().empty()) return 1;
    // Without a limit, Ctrl-C is the normal end of a recording.
    return stop.requested() && !r.limit_reached && (o.frames > 0 || o.seconds > 0) ? interrupted_code() : 0;
}

} // namespace

void add_ar_cameras(CLI::App& ar, int& exit_code)
{
    auto const json = std::make_shared<bool>(false);
    CLI::App* const c = ar.add_subcommand("cameras", "List the cameras that libcamera finds.");
    c->add_flag("--json", *json, "print JSON");
    c->footer(R"(Examples:
  lightwell ar cameras
  lightwell ar cameras --json)");
    c->callback([json, &exit_code] { exit_code = run_cameras(*json); });
}

void add_ar_record(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<RecordOptions>();
    CLI::App* const c = ar.add_subcommand("record", "Record unchanged camera frames with their times.");
    declare_source_arguments(*c, o->source);
    c->add_option("-o,--out", o->out, "folder to create; must not exist")->required();
    c->add_option("--frames", o->frames, "end after this many frames")->check(in_range(1, 1e9));
    c->add_option("--seconds", o->seconds, "end after this many seconds")->check(in_range(1e-3, 1e6));
    c->add_option("--calibration", o->calibration, "of the camera: it is checked and its name is stored");
    c->add_option("--note", o->note, "text stored with the session");
    c->add_flag("--json", o->json, "print the counts as JSON");
    c->footer(R"(Examples:
  lightwell ar record counter --out recorded --seconds 0.5
  lightwell ar record counter --out short --frames 5 --size 320x240 --rate 60 --json

Without --frames or --seconds it records until Ctrl-C. However it ends, all frames written so far can be played.
Exit code 1: the camera failed or the disk was full.)");
    c->callback([o, &exit_code] { exit_code = run_record(*o); });
}

} // namespace viewer
