#include "ar/light/mirror_ball.h"
#include "gi/core/error.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr int kPlaces = 360;
constexpr int kFewestPlaces = 60;

/// Log-like luminance: edges count by ratio, so that a lamp in the ball is no stronger than its rim.
cv::Mat brightness(cv::Mat const& rgb)
{
    cv::Mat f, grey;
    rgb.convertTo(f, CV_32F, rgb.depth() == CV_8U ? 1 / 255.0 : 1);
    cv::cvtColor(f, grey, cv::COLOR_RGB2GRAY);
    double const mean = cv::mean(grey)[0];
    grey.forEach<float>([&](float& v, int const*) {
        v = std::isfinite(v) ? std::log(std::max(0.0f, v) + float(0.05 * mean) + 1e-6f) : 0;
    });
    cv::GaussianBlur(grey, grey, {0, 0}, 0.7);
    return grey;
}

std::optional<float> at(cv::Mat const& grey, glm::dvec2 p)
{
    if (!(p.x >= 0 && p.y >= 0 && p.x < grey.cols - 1 && p.y < grey.rows - 1)) return std::nullopt;
    int const x = int(p.x), y = int(p.y);
    auto const fx = float(p.x - x), fy = float(p.y - y);
    auto const *a = grey.ptr<float>(y) + x, *b = grey.ptr<float>(y + 1) + x;
    return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

struct Rim {
    std::vector<glm::dvec3> rays;
    double rad_per_px = 0; ///< across the rim, on average
};

/// Finds the steepest step across the rim at each position; its maximum is that
/// of the parabola through three differences.
Rim rim_points(cv::Mat const& grey, CameraModel const& camera, BallSight const& near, double search)
{
    glm::dvec3 const any = std::abs(near.axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    glm::dvec3 const a = glm::normalize(glm::cross(near.axis, any)), b = glm::cross(near.axis, a);
    auto const ray = [&](double turn, double angle) {
        return std::cos(angle) * near.axis + std::sin(angle) * (std::cos(turn) * a + std::sin(turn) * b);
    };
    Rim rim;
    double px_per_rad = 0;
    int counted = 0;
    double const inner = near.half_angle_rad * (1 - search), outer = near.half_angle_rad * (1 + search);
    for (int i = 0; i < kPlaces; ++i) {
        double const turn = 2 * std::numbers::pi * i / kPlaces;
        auto const p0 = project(camera, ray(turn, inner)), p1 = project(camera, ray(turn, outer));
        if (!p0 || !p1) continue;
        double const length = glm::length(*p1 - *p0);
        int const n = std::clamp(int(2 * length), 8, 4000); // half a pixel each
        std::vector<float> steps;
        std::optional<float> before;
        for (int k = 0; k <= n; ++k) {
            auto const p = project(camera, ray(turn, inner + (outer - inner) * k / n));
            auto const v = p ? at(grey, *p) : std::nullopt;
            if (!v) break;
            if (before) steps.push_back(std::abs(*v - *before));
            before = v;
        }
        if (int(steps.size()) < n) continue; // leaves the picture
        px_per_rad += length / (outer - inner);
        ++counted;
        std::size_t const top = std::size_t(std::max_element(steps.begin() + 1, steps.end() - 1) - steps.begin());
        float const l = steps[top - 1], c = steps[top], r = steps[top + 1], bend = l - 2 * c + r;
        if (!(c > 0.02f)) continue; // no edge here
        double const off = bend < 0 ? std::clamp(0.5 * double((l - r) / bend), -0.5, 0.5) : 0;
        rim.rays.push_back(ray(turn, inner + (outer - inner) * (double(top) + 0.5 + off) / n));
    }
    rim.rad_per_px = counted ? counted / px_per_rad : 0;
    return rim;
}

/// d.m = 1 by least squares, with weights 1 / (1 + (miss / scale)^2)^2 that follow the median of the misses.
BallSight fit_cone(Rim const& rim, BallSight const& start)
{
    BallSight ball = start;
    double scale = 1e9;
    for (int round = 0; round < 30; ++round) {
        std::vector<double> misses;
        for (glm::dvec3 const& d : rim.rays)
            misses.push_back(std::acos(std::clamp(glm::dot(d, ball.axis), -1.0, 1.0)) - ball.half_angle_rad);
        std::vector<double> sizes;
        for (double const m : misses) sizes.push_back(std::abs(m));
        scale = std::max(0.2 * rim.rad_per_px, 3 * gi::median(std::move(sizes)));
        cv::Matx33d a = cv::Matx33d::zeros();
        cv::Vec3d b(0, 0, 0);
        double sum = 0, weights = 0;
        ball.rim_points = 0;
        for (std::size_t i = 0; i < rim.rays.size(); ++i) {
            double const u = misses[i] / scale, w = 1 / ((1 + u * u) * (1 + u * u));
            cv::Vec3d const d(rim.rays[i].x, rim.rays[i].y, rim.rays[i].z);
            a += w * (d * d.t());
            b += w * d;
            if (std::abs(u) > 1) continue;
            ++ball.rim_points;
            sum += misses[i] * misses[i];
            weights += 1;
        }
        cv::Vec3d m;
        if (!cv::solve(a, b, m, cv::DECOMP_SVD) || !(cv::norm(m) > 1)) break;
        double const length = cv::norm(m);
        ball.axis = glm::dvec3(m[0], m[1], m[2]) / length;
        ball.half_angle_rad = std::acos(1 / length);
        ball.rms_px = weights > 0 ? std::sqrt(sum / weights) / rim.rad_per_px : 0;
    }
    return ball;
}

} // namespace

BallSight find_ball(cv::Mat const& rgb, CameraModel const& camera, BallSight const& near, double search)
{
    CV_Assert(rgb.type() == CV_8UC3 || rgb.type() == CV_32FC3);
    cv::Mat const grey = brightness(rgb);
    BallSight ball = near;
    for (double const width : {search, search / 3, search / 8}) { // edges in the ball must not pull at it
        Rim const rim = rim_points(grey, camera, ball, std::max(width, 0.02));
        if (int(rim.rays.size()) < kFewestPlaces)
            throw gi::InputError(
                fmt::format("{} of {} places of the ball's rim show an edge", rim.rays.size(), kPlaces),
                fmt::format("{} are needed to know where it is", kFewestPlaces),
                "show the whole ball before a background unlike it, or give its circle");
        ball = fit_cone(rim, ball);
    }
    if (ball.rim_points < kFewestPlaces || !(ball.rms_px < 2))
        throw gi::InputError(fmt::format("the rim of the ball is {:.1f} px off a circle in {} places", ball.rms_px,
                                         ball.rim_points),
                             "it is something else or partly hidden",
                             "give the circle that its rim is in the picture");
    return ball;
}

BallSight find_ball(cv::Mat const& rgb, CameraModel const& camera)
{
    CV_Assert(rgb.type() == CV_8UC3 || rgb.type() == CV_32FC3);
    cv::Mat grey = brightness(rgb), bytes;
    // Circles are sought in a small picture.
    double const to = std::max(1.0, std::max(grey.cols, grey.rows) / 640.0);
    cv::resize(grey, grey, {}, 1 / to, 1 / to, cv::INTER_AREA);
    cv::normalize(grey, bytes, 0, 255, cv::NORM_MINMAX, CV_8U);
    cv::GaussianBlur(bytes, bytes, {0, 0}, 1.5);
    std::vector<cv::Vec3f> circles;
    cv::HoughCircles(bytes, circles, cv::HOUGH_GRADIENT, 1.5, bytes.rows / 8.0, 100, 40, bytes.rows / 40,
                     bytes.rows / 2);
    std::optional<BallSight> best;
    for (std::size_t i = 0; i < std::min<std::size_t>(circles.size(), 5); ++i) {
        glm::dvec2 const centre = (glm::dvec2(circles[i][0], circles[i][1]) + 0.5) * to - 0.5;
        try {
            BallSight const b = find_ball(rgb, camera, ball_of_circle(camera, centre, circles[i][2] * to));
            if (!best || b.rim_points > best->rim_points) best = b;
        } catch (gi::InputError const&) {
            continue; // not a ball; the next circle may be
        }
    }
    if (!best)
        throw gi::InputError(fmt::format("no ball in the picture, {} circles looked at", circles.size()),
                             "none has the rim of a ball", "give the circle that its rim is in the picture");
    return *best;
}

} // namespace ar
