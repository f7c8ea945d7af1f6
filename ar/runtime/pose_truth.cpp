#include "ar/runtime/pose_truth.h"

#include "gi/core/quantile.h"

#include <array>
#include <fmt/format.h>

namespace ar {

std::vector<ConfidenceBin> confidence_curve(std::vector<PoseError> const& errors)
{
    constexpr std::array<double, 8> edges{0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 1};
    std::vector<ConfidenceBin> curve;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        ConfidenceBin bin{edges[k], edges[k + 1]};
        std::vector<double> mm, deg;
        for (PoseError const& e : errors)
            if (e.confidence >= bin.low && (e.confidence < bin.high || k + 2 == edges.size())) {
                mm.push_back(e.position_mm);
                deg.push_back(e.rotation_deg);
            }
        bin.frames = mm.size();
        if (!mm.empty()) {
            bin.median_mm = gi::quantile(mm, 0.5);
            bin.p95_mm = gi::quantile(mm, 0.95);
            bin.median_deg = gi::quantile(deg, 0.5);
            bin.p95_deg = gi::quantile(deg, 0.95);
        }
        curve.push_back(bin);
    }
    return curve;
}

std::string to_csv(std::vector<ConfidenceBin> const& curve)
{
    std::string text =
        "confidence_low,confidence_high,frames,position_median_mm,position_p95_mm,rotation_median_deg,"
        "rotation_p95_deg\n";
    for (ConfidenceBin const& b : curve) {
        text += fmt::format("{},{},{},", b.low, b.high, b.frames);
        text += b.frames == 0
                    ? ",,,\n"
                    : fmt::format("{:.4f},{:.4f},{:.5f},{:.5f}\n", b.median_mm, b.p95_mm, b.median_deg, b.p95_deg);
    }
    return text;
}

void PoseTruth::add(std::uint64_t sequence, gi::RigidPose const& truth,
                    std::optional<gi::RigidPose> const& estimated, double confidence, PoseState state,
                    std::optional<gi::RigidPose> const& used)
{
    if (estimated)
        estimates_.push_back({confidence, 1e3 * glm::length(estimated->position - truth.position),
                              angle_between_deg(estimated->rotation, truth.rotation)});
    if (!used) {
        last_.reset();
        return;
    }
    glm::dvec3 const off = used->position - truth.position;
    if (last_ && sequence == last_sequence_ + 1) {
        double const jump_mm = 1e3 * glm::length(off - *last_);
        ++steps_;
        largest_jump_mm_ = std::max(largest_jump_mm_, jump_mm);
        jumps_ += jump_mm > kJump_mm;
        tracked_jumps_ += jump_mm > kJump_mm && state == PoseState::tracked && last_state_ == PoseState::tracked;
    }
    last_ = off;
    last_state_ = state;
    last_sequence_ = sequence;
}

std::string describe(PoseTruth const& t)
{
    if (t.estimates().empty()) return {};
    std::string text = t.steps() == 0
                           ? std::string("jumps: - (no two successive frames with a pose)\n")
                           : fmt::format("jumps of more than {:g} mm: {} in {} steps, {} of them between tracked "
                                         "frames; largest {:.1f} mm\n",
                                         kJump_mm, t.jumps(), t.steps(), t.tracked_jumps(), t.largest_jump_mm());
    text += fmt::format("{:<16} {:>7} {:>11} {:>9} {:>11} {:>9}\n", "confidence", "frames", "median (mm)", "95 %",
                        "median (deg)", "95 %");
    for (ConfidenceBin const& b : confidence_curve(t.estimates()))
        if (b.frames > 0)
            text += fmt::format("{:<16} {:>7} {:>11.2f} {:>9.2f} {:>11.3f} {:>9.3f}\n",
                                fmt::format("{:.2f} to {:.2f}", b.low, b.high), b.frames, b.median_mm, b.p95_mm,
                                b.median_deg, b.p95_deg);
    return text;
}

} // namespace ar
