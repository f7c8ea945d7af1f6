#include "ar/runtime/run_doubts.h"

#include "ar/pose/expected_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace ar {
namespace {

constexpr double kFar_m = 100;
constexpr double kFewLost = 0.1; ///< share of frames that may be without a trusted pose

std::string frame_name(RunFrame const& f) { return fmt::format("frame {}", f.sequence); }

void doubt_poses(RunSummary const& s, gi::Report& report)
{
    for (RunFrame const& f : s.frames) {
        if (f.world_from_camera && f.expected_error_m && f.distance_m > 0 &&
            *f.expected_error_m > kDoubtfulErrorShare * f.distance_m)
            report.lose(fmt::format("in doubt: poses that are likely off by more than {:g} % of their distance",
                                    100 * kDoubtfulErrorShare),
                        1,
                        fmt::format("{}: expected error {:.0f} mm at {:.2f} m, {}", frame_name(f),
                                    1e3 * *f.expected_error_m, f.distance_m, name_of(f.state)));
        if (f.distance_m > kFar_m)
            report.lose(fmt::format("in doubt: cameras more than {:g} m from their markers", kFar_m), 1,
                        fmt::format("{}: {:.4g} m; are the lengths of the markers in metres?", frame_name(f),
                                    f.distance_m));
    }
}

/// Longest side of a marker of the map in any frame, pixels; 0: none is in front of the camera, or no pose is known.
double longest_side_px(RunSummary const& s, std::vector<TimedPose> const& true_poses)
{
    double most = 0;
    if (true_poses.empty()) return most;
    std::vector<PlacedMarker> const markers = placed_markers(s.markers);
    for (RunFrame const& f : s.frames) {
        auto const world_from_camera = recorded_pose(true_poses, f.captured_s);
        if (!world_from_camera) continue;
        for (PlacedMarker const& m : markers) {
            gi::RigidPose const camera_from_thing =
                inverse(*world_from_camera) * world_from_thing(s.markers, m.thing);
            for (std::size_t i = 0; i < 4; ++i) {
                auto const a = project(s.camera, camera_from_thing * m.corners_m[i]),
                           b = project(s.camera, camera_from_thing * m.corners_m[(i + 1) % 4]);
                if (a && b) most = std::max(most, glm::length(*a - *b));
            }
        }
    }
    return most;
}

/// At which distance markers are large enough; empty: most frames have other causes.
std::string size_hint(RunSummary const& s, std::vector<TimedPose> const& true_poses = {})
{
    constexpr double kLeastSide_px = 25;
    auto const blind = std::size_t(std::count_if(s.frames.begin(), s.frames.end(),
                                                 [](RunFrame const& f) { return f.lost_by == "no markers"; }));
    std::size_t const lost = s.frames.size() - count_found(s.frames);
    if (blind == 0 || 2 * blind < lost || s.camera.size_px.x == 0) return {};
    if (s.other_dictionary)
        return fmt::format(
            "markers {} of {} are in the pictures, which the map does not have: is its dictionary right?",
            ranges_of(s.other_dictionary->ids), s.other_dictionary->name);
    double largest_m = 0;
    for (PlacedMarker const& m : placed_markers(s.markers))
        largest_m = std::max(largest_m, glm::length(m.corners_m[1] - m.corners_m[0]));
    std::string const text = fmt::format(
        "markers need sides of {:g} pixels or more; in these pictures of {} x {} those of {:.3g} mm have "
        "them up to {:.2g} m from the camera",
        kLeastSide_px, s.camera.size_px.x, s.camera.size_px.y, 1e3 * largest_m,
        s.camera.fx * largest_m / kLeastSide_px);
    double const side_px = longest_side_px(s, true_poses);
    return side_px > 0 ? text + fmt::format(" (by the true poses theirs are {:.0f} pixels at most)", side_px)
                       : text;
}

void doubt_lost(RunSummary const& s, gi::Report& report)
{
    std::size_t const found = count_found(s.frames), lost = s.frames.size() - found;
    if (found == 0 || double(lost) <= kFewLost * double(s.frames.size())) return; // none found: exit code 1
    std::string const hint = size_hint(s);
    report.lose("in doubt: frames without a trusted pose of their own", lost,
                fmt::format("{:.0f} % of {}, mostly: {}{}", 100.0 * double(lost) / double(s.frames.size()),
                            s.frames.size(), most_lost_by(s.frames), hint.empty() ? "" : "; " + hint));
}

void doubt_calibration(RunSummary const& s, gi::Report& report)
{
    if (s.focal) report.lose("in doubt: focal length of the calibration", 1, describe(*s.focal, s.camera));
}

void doubt_ids(RunSummary const& s, gi::Report& report)
{
    IdFinding const ids = compare_ids(s.ids, s.markers);
    if (!ids.remedy.empty())
        report.lose("in doubt: identifiers of the map's markers", 1, ids.problem + "; " + ids.remedy);
}

/// Composites in which next to no pixel changed, though the camera is known.
void doubt_nothing_seen(RunSummary const& s, gi::Report& report)
{
    constexpr double kNextToNone = 1e-4;
    std::map<Visibility, std::size_t> why;
    std::size_t n = 0, most = 0;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (RunFrame const& f : s.frames) {
        if (f.counts.pixels == 0) continue;
        std::size_t const changed = f.counts.pixels - f.counts.copied;
        bool const shows = double(changed) > kNextToNone * double(f.counts.pixels);
        if (shows || f.visibility == Visibility::unknown) return;
        ++n;
        ++why[f.visibility];
        most = std::max(most, changed);
        nearest_m = std::min(nearest_m, f.virtual_m);
    }
    if (n == 0) return;
    std::string reasons;
    for (auto const& [v, count] : why)
        reasons += fmt::format("{}{} in {}", reasons.empty() ? "" : ", ",
                               v == Visibility::seen
                                   ? "in the picture, but covered by real objects in front or of the same colours"
                                   : name_of(v),
                               count);
    report.lose(
        "in doubt: composites that show nothing virtual", n,
        fmt::format("they equal the camera's frames in all pixels but {}; the virtual objects are {}, {:.3g} m "
                    "away or more",
                    most, reasons, nearest_m));
}

} // namespace

void report_doubts(RunSummary const& s, gi::Report& report)
{
    doubt_poses(s, report);
    doubt_lost(s, report);
    doubt_calibration(s, report);
    doubt_ids(s, report);
    doubt_nothing_seen(s, report);
}

std::string hint_of(RunSummary const& s, std::vector<TimedPose> const& true_poses)
{
    std::string hint;
    auto const add = [&](std::string const& text) {
        if (!text.empty()) hint += (hint.empty() ? "" : "; ") + text;
    };
    IdFinding const ids = compare_ids(s.ids, s.markers);
    add(ids.problem);
    add(ids.remedy);
    if (s.focal) add(describe(*s.focal, s.camera));
    add(size_hint(s, true_poses));
    return hint;
}

} // namespace ar
