#include "ar/pose/candidates.h"

#include "gi/core/rotation.h"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <set>
#include <tuple>

namespace ar {
namespace {

constexpr double kOffPlane = 1e-3; ///< of the extent: boards are not flatter
constexpr double kOffLine = 1e-4;

/// A camera that looks at the middle of the rays: `camera_from_aimed` turns its frame to the camera's.
struct AimedPoints {
    glm::dquat camera_from_aimed{1, 0, 0, 0};
    std::vector<cv::Point3d> object; ///< in the axes of the point set, in units of its extent
    std::vector<cv::Point2d> image;  ///< on the plane z = 1
};

glm::dquat turn_z_to(glm::dvec3 direction)
{
    glm::dvec3 const z(0, 0, 1);
    glm::dvec3 const axis = glm::cross(z, direction);
    double const sine = glm::length(axis), cosine = direction.z;
    if (sine < 1e-12) return cosine > 0 ? glm::dquat(1, 0, 0, 0) : glm::dquat(0, 1, 0, 0);
    return gi::exp_rotation(axis * (std::atan2(sine, cosine) / sine));
}

AimedPoints aim(CameraModel const& camera, std::span<SightedPoint const> points, PointSet const& set)
{
    std::vector<std::pair<glm::dvec3, glm::dvec3>> rays; // direction, object point
    glm::dvec3 sum(0);
    for (SightedPoint const& p : points)
        if (auto const d = direction_of(camera, p.pixel)) {
            rays.emplace_back(*d, glm::transpose(set.axes) * (p.world_m - set.centre_m) / set.extent_m);
            sum += *d;
        }
    AimedPoints aimed;
    if (!(glm::length(sum) > 1e-9)) return aimed;
    aimed.camera_from_aimed = turn_z_to(glm::normalize(sum));
    for (auto const& [d, x] : rays) {
        glm::dvec3 const a = glm::conjugate(aimed.camera_from_aimed) * d;
        if (a.z < 0.17) continue;
        aimed.image.emplace_back(a.x / a.z, a.y / a.z);
        aimed.object.emplace_back(x.x, x.y, set.shape == Shape::plane ? 0.0 : x.z);
    }
    return aimed;
}

void solve(AimedPoints const& aimed, PointSet const& set, cv::SolvePnPMethod method,
           std::vector<gi::RigidPose>& out)
{
    std::vector<cv::Mat> rotations, translations;
    try {
        cv::solvePnPGeneric(aimed.object, aimed.image, cv::Matx33d::eye(), cv::noArray(), rotations, translations,
                            false, method);
    } catch (cv::Exception const&) {
        return; // degenerate: OpenCV says so by exceptions
    }
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        cv::Vec3d r, t;
        rotations[i].reshape(1, 3).convertTo(r, CV_64F);
        translations[i].reshape(1, 3).convertTo(t, CV_64F);
        if (!std::isfinite(cv::norm(r)) || !std::isfinite(cv::norm(t))) continue;
        gi::RigidPose aimed_from_set = pose_of(r, t);
        aimed_from_set.position *= set.extent_m;
        gi::RigidPose const set_from_camera = inverse(gi::RigidPose{{}, aimed.camera_from_aimed} * aimed_from_set);
        gi::RigidPose const world_from_set{set.centre_m, glm::normalize(glm::quat_cast(set.axes))};
        gi::RigidPose const pose = world_from_set * set_from_camera;
        if (std::isfinite(glm::length(pose.position)) && std::abs(glm::length(pose.rotation) - 1) < 1e-6)
            out.push_back(pose);
    }
}

} // namespace

PointSet survey(std::span<SightedPoint const> points)
{
    PointSet s;
    std::set<std::tuple<double, double, double>> places;
    for (SightedPoint const& p : points)
        if (places.emplace(p.world_m.x, p.world_m.y, p.world_m.z).second) s.centre_m += p.world_m;
    s.different = int(places.size());
    if (s.different < 2) return s;
    s.centre_m /= double(s.different);
    cv::Matx33d spread = cv::Matx33d::zeros();
    for (auto const& [x, y, z] : places) {
        glm::dvec3 const d = glm::dvec3(x, y, z) - s.centre_m;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) spread(r, c) += d[r] * d[c] / double(s.different);
    }
    cv::Vec3d values;
    cv::Matx33d vectors;
    cv::eigen(spread, values, vectors);
    s.extent_m = std::sqrt(cv::trace(spread));
    if (!(s.extent_m > 0) || !std::isfinite(s.extent_m)) return s;
    for (int c = 0; c < 2; ++c)
        for (int r = 0; r < 3; ++r) s.axes[c][r] = vectors(c, r);
    s.axes[2] = glm::cross(s.axes[0], s.axes[1]);
    auto const off = [&](int i) { return std::sqrt(std::max(0.0, values[i])) / s.extent_m; };
    s.shape = off(1) < kOffLine ? Shape::line : off(2) < kOffPlane ? Shape::plane : Shape::solid;
    return s;
}

std::vector<gi::RigidPose> candidates(CameraModel const& camera, std::span<SightedPoint const> points)
{
    PointSet const set = survey(points);
    if (set.different < 4 || set.shape == Shape::point || set.shape == Shape::line) return {};
    AimedPoints const aimed = aim(camera, points, set);
    std::vector<gi::RigidPose> found;
    if (aimed.image.size() < 4) return found;
    if (set.shape == Shape::plane) solve(aimed, set, cv::SOLVEPNP_IPPE, found);
    solve(aimed, set, cv::SOLVEPNP_SQPNP, found);
    return found;
}

} // namespace ar
