#include "ar/pose/refine.h"

#include "gi/core/rotation.h"

#include <cmath>

namespace ar {
namespace {

using Vec6 = cv::Vec<double, 6>;
constexpr double kNowhere = 1e9;

glm::dvec3 in_camera(gi::RigidPose const& world_from_camera, glm::dvec3 world)
{
    return glm::conjugate(world_from_camera.rotation) * (world - world_from_camera.position);
}

struct Equations {
    cv::Matx66d a = cv::Matx66d::zeros(); ///< J^T W J
    Vec6 b;                               ///< -J^T W r
    double cost = 0;
};

/// Geman and McClure: weight (1 / (1 + u^2))^2 of cost u^2 / (1 + u^2), u = miss / scale.
double weight_of(double sigmas2, double scale)
{
    if (!(scale > 0)) return 1;
    double const u = 1 / (1 + sigmas2 / (scale * scale));
    return u * u;
}

double cost_of(double sigmas2, double scale)
{
    return scale > 0 ? sigmas2 / (1 + sigmas2 / (scale * scale)) : sigmas2;
}

double cost(CameraModel const& camera, std::span<SightedPoint const> points, gi::RigidPose const& pose,
            double scale)
{
    double sum = 0;
    for (SightedPoint const& p : points) {
        double const miss = miss_sigmas(camera, pose, p);
        sum += cost_of(miss * miss, scale);
    }
    return sum;
}

Equations equations(CameraModel const& camera, std::span<SightedPoint const> points, gi::RigidPose const& pose,
                    double scale)
{
    Equations e;
    glm::dmat3 const camera_from_world = glm::mat3_cast(glm::conjugate(pose.rotation));
    for (SightedPoint const& p : points) {
        glm::dvec3 const x = in_camera(pose, p.world_m);
        auto const at = project(camera, x);
        if (!at) {
            e.cost += cost_of(kNowhere * kNowhere, scale);
            continue;
        }
        glm::dvec2 const miss = (*at - p.pixel) / p.sigma_px;
        double const w = weight_of(glm::dot(miss, miss), scale);
        double const h = 1e-6 * glm::length(x);
        double by_x[2][3];
        bool seen = true;
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 step(0);
            step[k] = h;
            auto const more = project(camera, x + step), less = project(camera, x - step);
            seen = seen && more && less;
            for (int row = 0; seen && row < 2; ++row)
                by_x[row][k] = ((*more)[row] - (*less)[row]) / (2 * h * p.sigma_px);
        }
        e.cost += cost_of(glm::dot(miss, miss), scale);
        if (!seen) continue;
        for (int row = 0; row < 2; ++row) {
            glm::dvec3 const d(by_x[row][0], by_x[row][1], by_x[row][2]);
            // x = R^T (X - p): by p it is -R^T, by a rotation w about the camera's axes it is x cross w.
            glm::dvec3 const by_p = -(d * camera_from_world), by_w = glm::cross(d, x);
            Vec6 const j(by_p.x, by_p.y, by_p.z, by_w.x, by_w.y, by_w.z);
            e.a += w * (j * j.t());
            e.b -= w * miss[row] * j;
        }
    }
    return e;
}

gi::RigidPose moved(gi::RigidPose const& p, Vec6 const& d)
{
    return {p.position + glm::dvec3(d[0], d[1], d[2]),
            glm::normalize(p.rotation * gi::exp_rotation({d[3], d[4], d[5]}))};
}

/// Inverse of a symmetric matrix. Its units differ so much that rows and columns are scaled to 1 first.
std::optional<cv::Matx66d> inverted(cv::Matx66d const& a)
{
    Vec6 s;
    for (int i = 0; i < 6; ++i) {
        if (!(a(i, i) > 0) || !std::isfinite(a(i, i))) return std::nullopt;
        s[i] = 1 / std::sqrt(a(i, i));
    }
    cv::Matx66d const scaled = cv::Matx66d::diag(s) * a * cv::Matx66d::diag(s);
    cv::Matx<double, 6, 1> values;
    cv::Matx66d vectors;
    if (!cv::eigen(scaled, values, vectors) || !(values(5) > 1e-11 * values(0))) return std::nullopt;
    cv::Matx66d inverse = cv::Matx66d::zeros();
    for (int i = 0; i < 6; ++i) inverse += (1 / values(i)) * (vectors.row(i).t() * vectors.row(i));
    return cv::Matx66d::diag(s) * inverse * cv::Matx66d::diag(s);
}

} // namespace

std::optional<glm::dvec2> miss_px(CameraModel const& camera, gi::RigidPose const& pose, SightedPoint const& p)
{
    auto const at = project(camera, in_camera(pose, p.world_m));
    if (!at || !std::isfinite(at->x) || !std::isfinite(at->y)) return std::nullopt;
    return *at - p.pixel;
}

double miss_sigmas(CameraModel const& camera, gi::RigidPose const& pose, SightedPoint const& p)
{
    auto const miss = miss_px(camera, pose, p);
    return miss ? std::min(kNowhere, glm::length(*miss) / p.sigma_px) : kNowhere;
}

Refined refine(CameraModel const& camera, std::span<SightedPoint const> points, gi::RigidPose const& start,
               double robust_sigmas)
{
    gi::RigidPose pose = start;
    Equations e = equations(camera, points, pose, robust_sigmas);
    double damping = 1e-4;
    bool const rough = robust_sigmas > 0; // a step on the way
    for (int i = 0; i < (rough ? 12 : 40); ++i) {
        cv::Matx66d a = e.a;
        for (int k = 0; k < 6; ++k) a(k, k) += damping * e.a(k, k) + 1e-300;
        Vec6 step;
        if (!cv::solve(a, e.b, step, cv::DECOMP_CHOLESKY) && !cv::solve(a, e.b, step, cv::DECOMP_SVD)) break;
        gi::RigidPose const tried = moved(pose, step);
        double const now = cost(camera, points, tried, robust_sigmas);
        if (!(now <= e.cost)) {
            damping *= 8;
            if (damping > 1e12) break;
            continue;
        }
        double const gained = e.cost - now;
        pose = tried;
        e = equations(camera, points, pose, robust_sigmas);
        damping = std::max(1e-12, damping / 8);
        if (gained <= (rough ? 1e-3 : 1e-8) * e.cost + 1e-14) break;
    }
    return {pose, cost(camera, points, pose, 0), inverted(e.a)};
}

} // namespace ar
