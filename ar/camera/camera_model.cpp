#include "ar/camera/camera_model.h"

#include "ar/camera/lens_domain.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr std::array<char const*, 5> kNames{"pinhole", "radial_tangential", "rational", "fisheye", "stmap"};

/// Factor of the radial distortion. @param r2  squared distance from the axis on the plane z = 1
double radial(CameraModel const& c, double r2)
{
    auto const& d = c.distortion;
    double const k1 = d[0], k2 = d[1], k3 = d[4], k4 = d[5], k5 = d[6], k6 = d[7];
    return (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
}

/// Applies the lens distortion on the plane z = 1.
glm::dvec2 distorted(CameraModel const& c, glm::dvec2 p)
{
    double const p1 = c.distortion[2], p2 = c.distortion[3], r2 = glm::dot(p, p);
    return radial(c, r2) * p + glm::dvec2(2 * p1 * p.x * p.y + p2 * (r2 + 2 * p.x * p.x),
                                          p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * p.x * p.y);
}

double fisheye_radius(CameraModel const& c, double angle)
{
    auto const& d = c.distortion;
    double const a2 = angle * angle;
    return angle * (1 + a2 * (d[0] + a2 * (d[1] + a2 * (d[2] + a2 * d[3]))));
}

/// Between pixels of the camera and of its table.
glm::dvec2 table_px(CameraModel const& c, glm::dvec2 pixel)
{
    return (pixel + 0.5) * glm::dvec2(c.table->size_px()) / glm::dvec2(c.size_px) - 0.5;
}
glm::dvec2 camera_px(CameraModel const& c, glm::dvec2 pixel)
{
    return (pixel + 0.5) * glm::dvec2(c.size_px) / glm::dvec2(c.table->size_px()) - 0.5;
}

glm::dvec2 on_plane(CameraModel const& c, glm::dvec2 pixel)
{
    return {(pixel.x - c.cx) / c.fx, (pixel.y - c.cy) / c.fy};
}

/// Newton's method in two dimensions, with finite differences. Nothing where it does not converge within the
/// domain of the lens.
std::optional<glm::dvec2> undistorted_from(CameraModel const& c, glm::dvec2 target, glm::dvec2 start)
{
    glm::dvec2 p = start;
    for (int i = 0; i < 60; ++i) {
        glm::dvec2 const miss = distorted(c, p) - target;
        if (!std::isfinite(miss.x) || !std::isfinite(miss.y)) return std::nullopt;
        if (std::max(std::abs(miss.x), std::abs(miss.y)) < 1e-13) break;
        double const h = 1e-7 * std::max(1.0, glm::length(p));
        glm::dvec2 const by_x =
            (distorted(c, p + glm::dvec2(h, 0)) - distorted(c, p - glm::dvec2(h, 0))) / (2 * h);
        glm::dvec2 const by_y =
            (distorted(c, p + glm::dvec2(0, h)) - distorted(c, p - glm::dvec2(0, h))) / (2 * h);
        double const det = by_x.x * by_y.y - by_x.y * by_y.x;
        if (!(std::abs(det) > 1e-12)) return std::nullopt;
        glm::dvec2 step = glm::dvec2(by_y.y * miss.x - by_y.x * miss.y, by_x.x * miss.y - by_x.y * miss.x) / det;
        double const limit = 0.5 * (1 + glm::length(p)); // large steps would leave the physical branch
        if (glm::length(step) > limit) step *= limit / glm::length(step);
        p -= step;
    }
    glm::dvec2 const miss = distorted(c, p) - target;
    if (!(std::max(std::abs(miss.x), std::abs(miss.y)) < 1e-10)) return std::nullopt;
    // Where the distortion folds back, several rays share a pixel: require a monotonic radius.
    double const r = glm::length(p);
    if (!(r <= domain_of(c).radius)) return std::nullopt;
    if (r > 0 && glm::dot(distorted(c, p * (1 + 1e-6)) - distorted(c, p), p) <= 0) return std::nullopt;
    return p;
}

/// Largest x from 0 to `most` with grown(x) <= wanted, by bisection of a growing function.
template <class Function>
double where_it_reaches(double wanted, double most, Function const& grown)
{
    double low = 0, high = most;
    for (int i = 0; i < 80; ++i) {
        double const middle = 0.5 * (low + high);
        (grown(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

std::optional<glm::dvec2> undistorted(CameraModel const& c, glm::dvec2 target)
{
    if (auto const p = undistorted_from(c, target, target)) return p;
    // Newton's steps may have jumped over a pole or a fold: start again where the radial terms alone would be.
    double const radius = glm::length(target);
    if (!(radius > 0)) return std::nullopt;
    double const r = where_it_reaches(radius, domain_of(c).radius, [&](double x) { return radial(c, x * x) * x; });
    return undistorted_from(c, target, r / radius * target);
}

} // namespace

int coefficient_count(LensModel lens)
{
    constexpr std::array<int, 5> counts{0, 5, 8, 4, 0};
    return counts[std::size_t(lens)];
}

std::string name_of(LensModel lens) { return kNames[std::size_t(lens)]; }

std::optional<LensModel> lens_named(std::string const& name)
{
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (name == kNames[i]) return LensModel(i);
    return std::nullopt;
}

cv::Matx33d camera_matrix(CameraModel const& c) { return {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1}; }

cv::Mat distortion_of(CameraModel const& c)
{
    cv::Mat all(1, coefficient_count(c.lens), CV_64F);
    for (int i = 0; i < all.cols; ++i) all.at<double>(i) = c.distortion[std::size_t(i)];
    return all;
}

std::optional<glm::dvec2> project(CameraModel const& c, glm::dvec3 point)
{
    glm::dvec2 p;
    if (c.lens == LensModel::fisheye) {
        double const across = std::hypot(point.x, point.y);
        if (!(across > 0 || point.z > 0)) return std::nullopt;
        double const angle = std::atan2(across, point.z);
        if (!(angle <= domain_of(c).radius)) return std::nullopt;
        double const r = fisheye_radius(c, angle);
        p = across > 0 ? r / across * glm::dvec2(point) : glm::dvec2(0);
    } else {
        if (!(point.z > 0)) return std::nullopt;
        if (c.lens == LensModel::stmap) {
            glm::dvec2 const straight = glm::dvec2(point) / point.z;
            auto const pixel = c.table->pixel_of(
                straight, table_px(c, glm::dvec2(c.fx * straight.x + c.cx, c.fy * straight.y + c.cy)));
            return pixel ? std::optional(camera_px(c, *pixel)) : std::nullopt;
        }
        p = glm::dvec2(point) / point.z;
        if (c.lens != LensModel::pinhole) {
            if (!(glm::length(p) <= domain_of(c).radius)) return std::nullopt;
            p = distorted(c, p);
        }
    }
    return glm::dvec2(c.fx * p.x + c.cx, c.fy * p.y + c.cy);
}

std::optional<glm::dvec3> direction_of(CameraModel const& c, glm::dvec2 pixel)
{
    if (c.lens == LensModel::stmap) {
        auto const p = c.table->plane_at(table_px(c, pixel));
        return p ? std::optional(glm::normalize(glm::dvec3(*p, 1))) : std::nullopt;
    }
    glm::dvec2 const target = on_plane(c, pixel);
    if (c.lens != LensModel::fisheye) {
        auto const p = c.lens == LensModel::pinhole ? target : undistorted(c, target);
        if (!p) return std::nullopt;
        return glm::normalize(glm::dvec3(*p, 1));
    }
    double const r = glm::length(target);
    if (!(r > 0)) return glm::dvec3(0, 0, 1);
    double const most = domain_of(c).radius;
    if (!(fisheye_radius(c, most) >= r)) return std::nullopt;
    double const angle = where_it_reaches(r, most, [&](double a) { return fisheye_radius(c, a); });
    return glm::dvec3(std::sin(angle) / r * target, std::cos(angle));
}

CameraModel scaled(CameraModel const& c, glm::ivec2 size_px)
{
    CameraModel s = c;
    glm::dvec2 const by = glm::dvec2(size_px) / glm::dvec2(c.size_px);
    s.size_px = size_px;
    s.fx = c.fx * by.x;
    s.fy = c.fy * by.y;
    s.cx = (c.cx + 0.5) * by.x - 0.5;
    s.cy = (c.cy + 0.5) * by.y - 0.5;
    return s;
}

cv::Mat remap_table(CameraModel const& to, CameraModel const& from)
{
    cv::Mat table(to.size_px.y, to.size_px.x, CV_32FC2);
    cv::parallel_for_({0, to.size_px.y}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < to.size_px.x; ++x) {
                auto const d = direction_of(to, {x, y});
                auto const p = d ? project(from, *d) : std::nullopt;
                table.at<cv::Vec2f>(y, x) = p ? cv::Vec2f(float(p->x), float(p->y)) : cv::Vec2f(-1e4f, -1e4f);
            }
    });
    return table;
}

namespace {

/// The steepest that the distorted radius grows with the undistorted one, from the axis to `radius`.
double steepest(CameraModel const& c, double radius)
{
    constexpr int kSteps = 1024;
    double most = 0, before = 0;
    for (int i = 1; i <= kSteps; ++i) {
        double const r = radius * i / kSteps, now = radial(c, r * r) * r;
        most = std::max(most, (now - before) * kSteps / radius);
        before = now;
    }
    return most;
}

/// Each pixel needs a ray; of fisheyes, whose corners may be dark, half of the picture.
template <class Refuse>
void check_rays(CameraModel const& c, Refuse const& refuse)
{
    constexpr double kSteepest = 20; // lenses stretch the border of a picture by 3 at most
    static char const* const suggestion =
        "calibrate again, up to the picture's corners or with fewer coefficients: lightwell ar calibrate --lens "
        "radial_tangential";
    if (c.lens == LensModel::fisheye) {
        LensReach const reach = reach_of(c);
        if (reach.share < 0.5)
            refuse(fmt::format("the lens model {}", describe(reach)), "less than half of it has rays", suggestion);
        return;
    }
    LensDomain const domain = domain_of(c);
    std::string const why =
        domain.end == DomainEnd::pole
            ? fmt::format("its denominator is 0 within the picture, {:.4g} focal lengths off the axis",
                          domain.radius)
        : domain.end == DomainEnd::fold
            ? fmt::format("its distortion folds back within the picture, {:.4g} focal lengths off the axis",
                          domain.radius)
            : "its distortion folds back within the picture";
    glm::dvec2 const corner(c.size_px.x - 1, c.size_px.y - 1);
    for (glm::dvec2 const p : {glm::dvec2(0, 0), glm::dvec2(corner.x, 0), glm::dvec2(0, corner.y), corner}) {
        auto const d = direction_of(c, p);
        if (!d)
            refuse(fmt::format("the lens model has no ray for the corner ({:g}, {:g})", p.x, p.y), why,
                   suggestion);
        if (c.lens != LensModel::rational) continue;
        if (double const most = steepest(c, glm::length(glm::dvec2(*d)) / d->z); most > kSteepest)
            refuse(fmt::format("the lens model stretches the picture {:.3g} times before the corner ({:g}, {:g})",
                               most, p.x, p.y),
                   domain.end == DomainEnd::pole ? why : "a lens does so 3 times at most", suggestion);
    }
}

} // namespace

void check(CameraModel const& c, std::string const& where)
{
    auto const refuse = [&](std::string const& problem, std::string const& why,
                            std::string const& suggestion = "calibrate the camera again") {
        throw gi::InputError(where + ": " + problem, why, suggestion);
    };
    for (double v : {c.fx, c.fy, c.cx, c.cy})
        if (!std::isfinite(v)) refuse("a number of the camera's matrix is not finite", "rays cannot be projected");
    for (double v : c.distortion)
        if (!std::isfinite(v)) refuse("a distortion coefficient is not finite", "rays cannot be projected");
    if (c.size_px.x < 1 || c.size_px.y < 1 || c.size_px.x > 65536 || c.size_px.y > 65536)
        refuse(fmt::format("pictures of {} x {} pixels", c.size_px.x, c.size_px.y),
               "1 to 65536 each way are possible");
    if (!(c.fx > 0) || !(c.fy > 0))
        refuse(fmt::format("focal lengths {} and {}", c.fx, c.fy), "both must be positive");
    if (std::abs(c.cx - 0.5 * c.size_px.x) > c.size_px.x || std::abs(c.cy - 0.5 * c.size_px.y) > c.size_px.y)
        refuse(fmt::format("the principal point ({}, {}) is far outside the picture", c.cx, c.cy),
               "the numbers are of another picture size or of a failed calibration");
    check_rays(c, refuse);
}

} // namespace ar
