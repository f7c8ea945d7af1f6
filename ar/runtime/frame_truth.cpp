#include "ar/runtime/frame_truth.h"

#include "ar/runtime/truth.h"
#include "gi/core/error.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {

FrameTruth::FrameTruth(std::filesystem::path pictures, std::vector<TimedPose> poses)
    : pictures_(std::move(pictures)), poses_(std::move(poses))
{
    if (!pictures_.empty() && !std::filesystem::is_directory(pictures_))
        throw gi::InputError("there is no folder '" + pictures_.string() + "'", "it should hold the truth",
                             "name the folder truth that `ar synthesize` made");
}

void FrameTruth::add(RunFrame const& f, FrameResult const& r)
{
    auto const truth_pose = pose_at(poses_, f.captured_s);
    if (truth_pose)
        errors_.poses.add(f.sequence, *truth_pose, f.estimated, f.confidence, f.state, f.world_from_camera);
    if (truth_pose && f.world_from_camera) {
        errors_.position_mm.push_back(1e3 * glm::length(f.world_from_camera->position - truth_pose->position));
        errors_.rotation_deg.push_back(angle_between_deg(f.world_from_camera->rotation, truth_pose->rotation));
    }
    if (pictures_.empty()) return;
    cv::Mat truth = cv::imread((pictures_ / fmt::format("{:06}.png", f.sequence)).string(), cv::IMREAD_COLOR);
    if (truth.empty() || truth.size() != r.rgb.size()) {
        ++errors_.missing;
        return;
    }
    cv::cvtColor(truth, truth, cv::COLOR_BGR2RGB);
    TruthErrors const e = errors_against_truth(eight_bits_of(r.rgb), eight_bits_of(r.camera), truth);
    errors_.flip_affected.push_back(e.flip_affected);
    errors_.flip_elsewhere.push_back(e.flip_elsewhere);
    errors_.camera_affected.push_back(e.camera_affected);
    errors_.camera_elsewhere.push_back(e.camera_elsewhere);
    errors_.affected_percent.push_back(100 * e.affected);
}

std::string describe(FrameErrors const& e)
{
    std::string t;
    auto const line = [&](char const* name, std::vector<double> const& values) {
        if (values.empty()) return;
        Spread const s = spread_of(values);
        t += fmt::format("{:<30} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, s.median, s.p95, s.most);
    };
    line("position error (mm)", e.position_mm);
    line("rotation error (deg)", e.rotation_deg);
    line("FLIP where it is affected", e.flip_affected);
    line("  of adding nothing", e.camera_affected);
    line("  share of the picture (%)", e.affected_percent);
    line("FLIP elsewhere", e.flip_elsewhere);
    line("  of adding nothing", e.camera_elsewhere);
    if (e.missing > 0) t += fmt::format("no truth of that size: {} frames\n", e.missing);
    std::string const poses = describe(e.poses);
    return t.empty() ? poses
                     : fmt::format("{:<30} {:>9} {:>9} {:>9}\n", "against the truth", "median", "95 %", "most") +
                           t + poses;
}

} // namespace ar
