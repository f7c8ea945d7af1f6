#include "ar/pipeline/camera_blur.h"

#include <array>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr double kNewest = 0.1;     ///< weight of the newest frame's blur
constexpr double kShortest_px = 14; ///< sides of markers: shorter ones have too little black beside them
constexpr double kStill_px = 0.5;   ///< of motion: frames that move more cannot show lens blur
constexpr int kFewestEdges = 4;

} // namespace

CameraBlur::CameraBlur(MarkerMap const& map, CameraModel const& camera) : camera_(camera)
{
    for (PlacedMarker const& m : placed_markers(map)) {
        gi::RigidPose const world_from_thing = ar::world_from_thing(map, m.thing);
        std::array<glm::dvec3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = world_from_thing * m.corners_m[k];
        markers_.push_back(corners);
    }
}

std::vector<EdgeSegment> CameraBlur::edges(gi::RigidPose const& world_from_camera, double& shortest_px) const
{
    gi::RigidPose const camera_from_world = inverse(world_from_camera);
    std::vector<EdgeSegment> found;
    for (auto const& corners : markers_) {
        glm::dvec3 const normal = glm::cross(corners[1] - corners[0], corners[3] - corners[0]);
        if (glm::dot(normal, world_from_camera.position - corners[0]) > 0) continue; // seen from behind
        for (std::size_t k = 0; k < 4; ++k) {
            auto const a = project(camera_, camera_from_world * corners[k]);
            auto const b = project(camera_, camera_from_world * corners[(k + 1) % 4]);
            if (!a || !b) continue;
            double const length = glm::distance(*a, *b);
            if (length < kShortest_px) continue;
            shortest_px = std::min(shortest_px, length);
            found.push_back({*a, *b});
        }
    }
    return found;
}

void CameraBlur::follow(cv::Mat const& radiance, gi::RigidPose const& world_from_camera, double time_s,
                        double exposure_s)
{
    opened_.reset();
    counts_.no_exposure += !(exposure_s > 0);
    double moved_px = 0;
    if (before_ && time_s > before_->time_s) {
        // Assumes constant motion since the previous frame; image motion from rotation,
        // and translation at one metre.
        double const share = exposure_s / (time_s - before_->time_s);
        gi::RigidPose const& b = before_->world_from_camera;
        double const turned = glm::radians(angle_between_deg(b.rotation, world_from_camera.rotation));
        double const shifted = glm::distance(b.position, world_from_camera.position);
        moved_px = share * camera_.fx * (turned + shifted);
        if (exposure_s > 0 && moved_px >= 1) {
            ++counts_.moved;
            opened_ = gi::RigidPose{glm::mix(world_from_camera.position, b.position, share),
                                    glm::slerp(world_from_camera.rotation, b.rotation, share)};
        }
    }
    before_ = Before{world_from_camera, time_s};
    if (moved_px > kStill_px) return;
    double shortest_px = 1e9;
    std::vector<EdgeSegment> const sides = edges(world_from_camera, shortest_px);
    // The border of a marker is a sixth of its side or less, and what lies beyond has another brightness.
    SpreadSettings settings;
    settings.reach_px = std::min(settings.reach_px, shortest_px / 7);
    std::optional<Sharpness> sharpness;
    if (!sides.empty()) {
        cv::Mat light;
        cv::cvtColor(radiance, light, cv::COLOR_RGB2GRAY);
        sharpness = estimate_sharpness(light, sides, settings);
    }
    if (!sharpness || sharpness->edges < kFewestEdges) {
        ++counts_.unmeasured;
        return;
    }
    ++counts_.measured;
    sigma_px_ = sigma_px_ ? *sigma_px_ + kNewest * (sharpness->sigma_px - *sigma_px_) : sharpness->sigma_px;
}

} // namespace ar
