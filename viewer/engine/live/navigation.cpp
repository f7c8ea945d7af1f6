#include "viewer/engine/live/navigation.h"

#include <algorithm>
#include <atomic>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {
namespace {

using gi::dmat4, gi::dvec3;

constexpr double kSteepest_rad = 1.5533; // 89 degrees
constexpr double kLongestStep_s = 0.1;
constexpr double kRise_m_s = 2; // vertical speed of the eyes on stairs

dmat4 turned(double yaw_rad, double pitch_rad)
{
    return glm::rotate(glm::rotate(dmat4(1), yaw_rad, dvec3{0, 1, 0}), pitch_rad, dvec3{1, 0, 0});
}

} // namespace

char const* name_of(NavigationMode mode)
{
    return mode == NavigationMode::fly ? "fly" : mode == NavigationMode::walk ? "walk" : "orbit";
}

Navigation::Navigation(dmat4 const& world_from_camera, double speed_m_s, dvec3 pivot)
    : pivot_(pivot), speed_m_s_(speed_m_s)
{
    go_to(world_from_camera);
}

void Navigation::go_to(dmat4 const& world_from_camera)
{
    static std::atomic<std::uint64_t> jumps{0};
    jump_ = ++jumps;
    dvec3 const back = glm::normalize(dvec3(world_from_camera[2]));
    position_ = dvec3(world_from_camera[3]);
    standing_.reset();
    pitch_rad_ = std::clamp(std::asin(std::clamp(-back.y, -1.0, 1.0)), -kSteepest_rad, kSteepest_rad);
    // Looking straight up or down, take the heading from the camera's own up vector.
    dvec3 const level = std::abs(back.y) < 0.9999 ? back : dvec3(world_from_camera[1]) * (back.y > 0 ? -1.0 : 1.0);
    yaw_rad_ = std::atan2(level.x, level.z);
}

void Navigation::set_ground(std::shared_ptr<Ground const> ground)
{
    ground_ = std::move(ground);
    standing_.reset();
}

void Navigation::set_mode(NavigationMode mode)
{
    mode_ = mode;
    standing_.reset();
    if (mode != NavigationMode::orbit) return;
    dvec3 const to = pivot_ - position_;
    if (double const far = glm::length(to); far > 1e-6) {
        yaw_rad_ = std::atan2(-to.x, -to.z);
        pitch_rad_ = std::clamp(std::asin(to.y / far), -kSteepest_rad, kSteepest_rad);
    }
}

void Navigation::step(NavigationInput const& in, double seconds)
{
    double const pace = speed_m_s_ * (in.fast ? 4 : in.slow ? 0.25 : 1) * std::clamp(seconds, 0.0, kLongestStep_s);
    yaw_rad_ = std::remainder(yaw_rad_ - in.turn_right_rad, 2 * gi::kPi);
    pitch_rad_ = std::clamp(pitch_rad_ + in.turn_up_rad, -kSteepest_rad, kSteepest_rad);
    if (mode_ == NavigationMode::orbit) {
        double distance = glm::length(pivot_ - position_);
        double const rate = std::clamp(seconds, 0.0, kLongestStep_s); // rad/s and shares of the distance
        yaw_rad_ = std::remainder(yaw_rad_ + in.right * rate, 2 * gi::kPi);
        pitch_rad_ = std::clamp(pitch_rad_ - in.up * rate, -kSteepest_rad, kSteepest_rad);
        distance = std::max(1e-3, distance * std::exp(-in.forward * rate - 0.1 * in.closer));
        position_ = pivot_ + distance * dvec3(turned(yaw_rad_, pitch_rad_)[2]);
        return;
    }
    bool const level = mode_ == NavigationMode::walk;
    dmat4 const axes = turned(yaw_rad_, level ? 0 : pitch_rad_);
    dvec3 const way{in.right, level ? 0 : in.up, -in.forward};
    dvec3 const by = pace * dvec3(axes * glm::dvec4(way, 0)) + 0.2 * in.closer * speed_m_s_ * -dvec3(axes[2]);
    if (level)
        walk_by(by, std::clamp(seconds, 0.0, kLongestStep_s));
    else
        position_ += by;
}

/// The foot climbs at once; the eyes follow at a steady speed.
void Navigation::walk_by(dvec3 way_m, double seconds)
{
    bool const moves = way_m != dvec3{0};
    if (moves && ground_ && !standing_) {
        standing_ = stand_below(*ground_, position_, eye_height_m_);
        if (standing_) position_.y = standing_->foot.y + standing_->eye_m;
    }
    if (!standing_) {
        position_ += way_m;
        return;
    }
    if (moves) standing_ = walk(*ground_, *standing_, way_m);
    double const rise = std::max(kRise_m_s * seconds, glm::length(way_m));
    double const eyes = standing_->foot.y + standing_->eye_m;
    position_ = {standing_->foot.x, position_.y + std::clamp(eyes - position_.y, -rise, rise), standing_->foot.z};
}

dmat4 Navigation::world_from_camera() const
{
    return glm::translate(dmat4(1), position_) * turned(yaw_rad_, pitch_rad_);
}

dmat4 Navigation::world_from_room() const { return glm::translate(dmat4(1), position_) * turned(yaw_rad_, 0); }

} // namespace viewer
