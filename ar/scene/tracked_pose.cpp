#include "ar/scene/tracked_pose.h"

#include "ar/capture/clock.h"
#include "ar/scene/read_values.h"
#include "gi/core/error.h"
#include "viewer/devices/tracking/display_tracker.h"
#include "viewer/displays/display_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

ar::Pose pose_in_ar(RoomPose const& p) { return {p.rotation, p.position}; }

DisplayTracker const& find_tracker(Display const& display, ArTracked const& t)
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
            poses.push_back(
                {time_s, pose_in_ar(to_room(settings.to_room, s.pose, settings.head.sensor_from_body))});
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

ArTracked read_tracked(gi::Yaml const& p, fs::path const& folder)
{
    ArTracked t;
    auto const pose = [&](char const* key, ar::Pose& to) {
        if (!p.has(key)) return;
        p.at(key).only_keys({"position_m", "rotation_deg", "rotation_xyzw"});
        ar::Pose const read = read_pose(p.at(key));
        bool const is_turned = p.at(key).has("rotation_deg") || p.at(key).has("rotation_xyzw");
        to = {is_turned ? read.rotation : to.rotation, read.position_m};
    };
    if (p.has("display")) t.display = folder / p.at("display").text();
    if (p.has("tracker")) t.tracker = p.at("tracker").text();
    pose("camera_from_sensor", t.camera_from_sensor);
    pose("world_from_room", t.world_from_room);
    if (p.has("offset_s")) t.offset_s = p.at("offset_s").number(-1e6, 1e6);
    return t;
}

std::vector<fs::path> files_read_by(ArTracked const& tracked)
{
    if (tracked.display.empty()) return {};
    gi::Report ignored;
    Display const display = load_display(tracked.display, ignored);
    std::vector<fs::path> files{tracked.display};
    for (Wall const& wall : display.walls)
        if (!wall.warp_file.empty()) files.push_back(tracked.display.parent_path() / wall.warp_file);
    DisplayTracker const& tracker = find_tracker(display, tracked);
    if (tracker.type == DisplayTrackerType::file) files.push_back(file_of(tracker, tracked.display));
    return files;
}

TrackedCamera::TrackedCamera(ArTracked const& tracked, gi::Report& report)
    : tracked_(tracked), sensor_from_camera_(ar::inverse(tracked.camera_from_sensor))
{
    if (tracked.display.empty())
        throw gi::InputError("a session with `pose` and without a display", "it has no trackers",
                             "set pose.display: FILE, or use --display FILE");
    Display const display = load_display(tracked.display, report);
    DisplayTracker const& tracker = find_tracker(display, tracked);
    TrackerSettings settings = tracker_settings(tracker);
    if (tracker.type == DisplayTrackerType::openxr || tracker.type == DisplayTrackerType::fake)
        throw gi::InputError("the tracker '" + tracker.name + "' cannot track a camera",
                             "headsets and keys move no camera", "use one of type osc, dtrack or file");
    if (tracker.type != DisplayTrackerType::file) {
        hub_ = std::make_unique<TrackerHub>(std::vector{settings}, Polling::by_thread);
        return;
    }
    for (ar::TimedPose const& p : samples_of(file_of(tracker, tracked.display), settings))
        recorded_.push_back({p.time_s - tracked.offset_s, world_from_camera(p.world_from_camera)});
}

TrackedCamera::TrackedCamera(ArTracked const& tracked, std::unique_ptr<TrackerHub> hub)
    : tracked_(tracked), sensor_from_camera_(ar::inverse(tracked.camera_from_sensor)), hub_(std::move(hub))
{
}

TrackedCamera::~TrackedCamera() = default;

std::vector<ar::TimedPose> recorded_poses(ArTracked const& tracked, gi::Report& report)
{
    TrackedCamera const camera(tracked, report);
    if (camera.is_live())
        throw gi::InputError("a session with a live tracker", "its poses cannot be repeated",
                             "use a tracker of type file, or a file of poses");
    return camera.recorded();
}

std::optional<ar::Pose> recorded_pose(std::vector<ar::TimedPose> const& poses, double time_s)
{
    constexpr double kRounding_s = 2e-6;
    double const first_s = poses.front().time_s, last_s = poses.back().time_s;
    if (time_s < first_s - kRounding_s || time_s > last_s + kRounding_s) return std::nullopt;
    return ar::pose_at(poses, std::clamp(time_s, first_s, last_s));
}

ar::Pose TrackedCamera::world_from_camera(ar::Pose const& room_from_sensor) const
{
    return tracked_.world_from_room * room_from_sensor * sensor_from_camera_;
}

std::optional<ar::Pose> TrackedCamera::at(double steady_s)
{
    ++asked_;
    BodiesAt const bodies = hub_->at(steady_s);
    if (bodies.states[0] != TrackState::tracked || !bodies.tracked.head) return std::nullopt;
    ++known_;
    return world_from_camera(pose_in_ar(*bodies.tracked.head));
}

std::string TrackedCamera::describe() const
{
    if (!hub_) return {};
    std::string text = fmt::format("tracker: {} frames, {} with a pose\n", asked_, known_);
    for (TrackerReport const& r : hub_->report(ar::steady_now_s()))
        text += fmt::format("  {}: {} packets, {} samples, {} malformed, {} lost\n", r.description,
                            r.counts.packets, r.counts.samples, r.counts.malformed, r.counts.lost);
    return text;
}

} // namespace viewer
