#include "viewer/camera_view/camera_tracker.h"

#include "ar/capture/clock.h"
#include "gi/core/error.h"
#include "viewer/devices/tracking/display_tracker.h"
#include "viewer/displays/display_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

DisplayTracker const& find_tracker(Display const& display, ar::TrackerUse const& t)
{
    std::string known;
    for (DisplayTracker const& tracker : display.trackers) {
        if (tracker.name == t.tracker) return tracker;
        known += (known.empty() ? "" : ", ") + tracker.name;
    }
    if (t.tracker.empty())
        for (User const& user : display.users)
            if (user.tracker >= 0) return display.trackers[std::size_t(user.tracker)];
    throw gi::InputError(t.tracker.empty() ? "'" + t.display.string() + "' has no user with a tracker"
                                           : "'" + t.display.string() + "' has no tracker '" + t.tracker + "'",
                         "the camera pose comes from it",
                         known.empty() ? "add one" : "write pose.tracker: one of " + known);
}

/// Samples with their times in seconds since the file's first sample.
std::vector<ar::TimedPose> samples_of(fs::path const& file, TrackerSettings const& settings)
{
    std::string const& body = settings.head.id;
    std::vector<ar::TimedPose> poses;
    auto const samples = read_tracker_file(file);
    for (TrackerSample const& s : samples) {
        if (s.body != body || !s.visible) continue;
        double const time_s = *s.measured_s - *samples.front().measured_s;
        if (poses.empty() || time_s > poses.back().time_s)
            poses.push_back({time_s, to_room(settings.to_room, s.pose, settings.head.sensor_from_body)});
    }
    if (poses.empty())
        throw gi::InputError("'" + file.string() + "' has no body '" + body + "'", "the camera pose comes from it",
                             "correct `body` of the tracker");
    return poses;
}

fs::path file_of(DisplayTracker const& tracker, fs::path const& display)
{
    fs::path const beside = display.parent_path() / tracker.file;
    return fs::exists(beside) ? beside : fs::path(tracker.file);
}

} // namespace

std::vector<fs::path> files_read_by(ar::TrackerUse const& use)
{
    if (use.display.empty()) return {};
    gi::Report ignored;
    Display const display = load_display(use.display, ignored);
    std::vector<fs::path> files{use.display};
    for (Wall const& wall : display.walls)
        for (std::string const& file : files_of(wall)) files.push_back(use.display.parent_path() / file);
    DisplayTracker const& tracker = find_tracker(display, use);
    if (tracker.type == DisplayTrackerType::file) files.push_back(file_of(tracker, use.display));
    return files;
}

CameraTracker::CameraTracker(ar::TrackerUse const& use, gi::Report& report)
    : use_(use), sensor_from_camera_(gi::inverse(use.camera_from_sensor))
{
    if (use.display.empty())
        throw gi::InputError("a session with `pose` and without a display", "it has no trackers",
                             "set pose.display: FILE, or use --display FILE");
    Display const display = load_display(use.display, report);
    DisplayTracker const& tracker = find_tracker(display, use);
    TrackerSettings settings = tracker_settings(tracker);
    if (tracker.type == DisplayTrackerType::openxr || tracker.type == DisplayTrackerType::fake)
        throw gi::InputError("the tracker '" + tracker.name + "' cannot track a camera",
                             "headsets and keys move no camera", "use one of type osc, dtrack or file");
    if (tracker.type != DisplayTrackerType::file) {
        hub_ = std::make_unique<TrackerHub>(std::vector{settings}, Polling::by_thread);
        return;
    }
    for (ar::TimedPose const& p : samples_of(file_of(tracker, use.display), settings))
        recorded_.push_back({p.time_s - use.offset_s, world_from_camera(p.world_from_camera)});
}

CameraTracker::CameraTracker(ar::TrackerUse const& use, std::unique_ptr<TrackerHub> hub)
    : use_(use), sensor_from_camera_(gi::inverse(use.camera_from_sensor)), hub_(std::move(hub))
{
}

CameraTracker::~CameraTracker() = default;

std::vector<ar::TimedPose> recorded_poses(ar::TrackerUse const& use, gi::Report& report)
{
    CameraTracker const camera(use, report);
    if (camera.is_live())
        throw gi::InputError("a session with a live tracker", "its poses cannot be repeated",
                             "use a tracker of type file, or a file of poses");
    return camera.recorded();
}

gi::RigidPose CameraTracker::world_from_camera(gi::RigidPose const& room_from_sensor) const
{
    return use_.world_from_room * room_from_sensor * sensor_from_camera_;
}

std::optional<gi::RigidPose> CameraTracker::at(double steady_s)
{
    ++asked_;
    BodiesAt const bodies = hub_->at(steady_s);
    if (bodies.states[0] != TrackState::tracked || !bodies.tracked.head) return std::nullopt;
    ++known_;
    return world_from_camera(*bodies.tracked.head);
}

std::string CameraTracker::describe() const
{
    if (!hub_) return {};
    std::string text = fmt::format("tracker: {} frames, {} with a pose\n", asked_, known_);
    for (TrackerReport const& r : hub_->report(ar::steady_now_s()))
        text += fmt::format("  {}: {} packets, {} samples, {} malformed, {} lost\n", r.description,
                            r.counts.packets, r.counts.samples, r.counts.malformed, r.counts.lost);
    return text;
}

} // namespace viewer
