#include "ar/pose/still_camera.h"

#include "gi/core/quantile.h"
#include "gi/core/rotation.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ar {
namespace {

double sigma_m(PoseEstimate const& e) { return std::max(1e-9, glm::length(e.position_sigma_m)); }
double sigma_deg(PoseEstimate const& e) { return std::max(1e-9, glm::length(e.rotation_sigma_deg)); }

bool agrees(StillSettings const& s, PoseEstimate const& e, gi::RigidPose const& with)
{
    double const off_m = glm::length(e.world_from_camera.position - with.position);
    double const off_deg = angle_between_deg(e.world_from_camera.rotation, with.rotation);
    return off_m <= std::max(s.least_m, s.limit_sigmas * sigma_m(e)) &&
           off_deg <= std::max(s.least_deg, s.limit_sigmas * sigma_deg(e));
}

/// Component by component; rotations as vectors about the one in the middle of the list.
gi::RigidPose median(std::deque<PoseEstimate> const& kept)
{
    gi::RigidPose const about = kept[kept.size() / 2].world_from_camera;
    gi::RigidPose m = about;
    glm::dvec3 turn;
    std::vector<double> v(kept.size());
    auto const middle = [&](auto const& value) {
        std::transform(kept.begin(), kept.end(), v.begin(), value);
        return gi::median(v);
    };
    for (int k = 0; k < 3; ++k) {
        m.position[k] = middle([&](PoseEstimate const& e) { return e.world_from_camera.position[k]; });
        turn[k] = middle([&](PoseEstimate const& e) {
            return gi::log_rotation(glm::conjugate(about.rotation) * e.world_from_camera.rotation)[k];
        });
    }
    m.rotation = glm::normalize(about.rotation * gi::exp_rotation(turn));
    return m;
}

StillPose mean_of(StillSettings const& s, std::deque<PoseEstimate> const& kept)
{
    gi::RigidPose const about = median(kept);
    StillPose mean;
    double weight_m = 0, weight_deg = 0;
    glm::dvec3 moved(0), turned(0), moved2(0);
    double turned2 = 0;
    for (PoseEstimate const& e : kept) {
        if (!agrees(s, e, about)) {
            ++mean.left_out;
            continue;
        }
        ++mean.averaged;
        double const m = 1 / (sigma_m(e) * sigma_m(e)), d = 1 / (sigma_deg(e) * sigma_deg(e));
        glm::dvec3 const by = e.world_from_camera.position - about.position;
        glm::dvec3 const turn = gi::log_rotation(glm::conjugate(about.rotation) * e.world_from_camera.rotation);
        weight_m += m;
        weight_deg += d;
        moved += m * by;
        turned += d * turn;
        moved2 += m * by * by;
        turned2 += d * glm::dot(turn, turn);
    }
    if (mean.averaged == 0) { // estimates scatter more than their standard deviations
        mean.world_from_camera = about;
        return mean;
    }
    moved /= weight_m;
    turned /= weight_deg;
    double const n = double(mean.averaged);
    mean.world_from_camera = {about.position + moved, glm::normalize(about.rotation * gi::exp_rotation(turned))};
    for (int k = 0; k < 3; ++k)
        mean.position_sigma_m[k] = std::sqrt(std::max(0.0, moved2[k] / weight_m - moved[k] * moved[k]) / n);
    mean.rotation_sigma_deg =
        glm::degrees(std::sqrt(std::max(0.0, turned2 / weight_deg - glm::dot(turned, turned)) / n));
    return mean;
}

} // namespace

bool StillCamera::add(PoseEstimate const& estimate)
{
    if (!estimate.found()) return false;
    astray_ = mean_ && !agrees(settings_, estimate, mean_->world_from_camera) ? astray_ + 1 : 0;
    kept_.push_back(estimate);
    bool const moved = astray_ >= settings_.moved_after;
    if (moved) {
        while (int(kept_.size()) > astray_) kept_.pop_front();
        astray_ = 0;
        ++moves_;
    }
    while (kept_.size() > settings_.keep) kept_.pop_front();
    mean_ = mean_of(settings_, kept_);
    return moved;
}

} // namespace ar
