#include "ar/runtime/pose_rows.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {

PoseRows compare_rows(std::vector<TimedPose> const& poses, std::vector<RunFrame> const& frames)
{
    constexpr double kRounding_s = 2e-6;
    PoseRows r{.poses = poses.size(), .frames = frames.size()};
    r.first_pose_s = poses.front().time_s;
    r.last_pose_s = poses.back().time_s;
    r.first_frame_s = frames.front().captured_s;
    r.last_frame_s = frames.back().captured_s;
    std::size_t const steps = frames.size() - 1;
    double const half_s = steps > 0 ? 0.5 * (r.last_frame_s - r.first_frame_s) / double(steps) : kRounding_s;
    for (TimedPose const& p : poses) {
        r.before += p.time_s < r.first_frame_s - half_s;
        r.after += p.time_s > r.last_frame_s + half_s;
    }
    for (RunFrame const& f : frames)
        r.uncovered += f.captured_s < r.first_pose_s - kRounding_s || f.captured_s > r.last_pose_s + kRounding_s;
    return r;
}

std::string describe(PoseRows const& r, std::string const& whose)
{
    if (r.before + r.after + r.uncovered == 0) return {};
    std::string what;
    auto const add = [&](std::size_t n, char const* text) {
        if (n > 0) what += fmt::format("{}{} {}", what.empty() ? "" : ", ", n, text);
    };
    add(r.before, "of them before the first frame");
    add(r.after, "of them after the last frame");
    add(r.uncovered, "frames have none");
    return fmt::format("{}: {} from {:.3f} to {:.3f} s, the {} frames are from {:.3f} to {:.3f} s; {}\n", whose,
                       r.poses, r.first_pose_s, r.last_pose_s, r.frames, r.first_frame_s, r.last_frame_s, what);
}

} // namespace ar
