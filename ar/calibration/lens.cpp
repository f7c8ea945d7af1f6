#include "ar/calibration/lens.h"

#include "gi/core/error.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

namespace ar {
namespace {

constexpr std::size_t kFewestViews = 3;

struct Fit {
    CameraModel camera;
    std::vector<gi::RigidPose> poses;
};

CameraModel camera_of(LensModel lens, glm::ivec2 size_px, cv::Mat const& k, cv::Mat const& distortion)
{
    CameraModel c;
    c.lens = lens;
    c.size_px = size_px;
    c.fx = k.at<double>(0, 0);
    c.fy = k.at<double>(1, 1);
    c.cx = k.at<double>(0, 2);
    c.cy = k.at<double>(1, 2);
    cv::Mat const d = distortion.reshape(1, 1);
    for (int i = 0; i < std::min(coefficient_count(lens), d.cols); ++i)
        c.distortion[std::size_t(i)] = d.at<double>(i);
    return c;
}

bool has_rays(CameraModel const& camera)
{
    try {
        check(camera, "");
    } catch (gi::InputError const&) {
        return false;
    }
    return true;
}

/// Least squares of all views by OpenCV.
Fit fit(std::vector<BoardView const*> const& views, glm::ivec2 size_px, LensModel lens)
{
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> pixels;
    for (BoardView const* v : views) {
        board.emplace_back();
        pixels.emplace_back();
        for (std::size_t i = 0; i < v->pixels.size(); ++i) {
            board.back().emplace_back(float(v->board_m[i].x), float(v->board_m[i].y), 0.f);
            pixels.back().emplace_back(float(v->pixels[i].x), float(v->pixels[i].y));
        }
    }
    cv::TermCriteria const until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 80, 1e-9);
    cv::Size const size(size_px.x, size_px.y);
    cv::Mat k, distortion;
    std::vector<cv::Mat> turns, shifts;
    Fit out;
    try {
        if (lens == LensModel::fisheye) {
            // Start from a lens whose half diagonal is 60 degrees:
            // the initial guess of fisheye::calibrate often fails.
            double const f = 0.5 * std::hypot(size_px.x, size_px.y) / 1.05;
            k = (cv::Mat_<double>(3, 3) << f, 0, 0.5 * size_px.x - 0.5, 0, f, 0.5 * size_px.y - 0.5, 0, 0, 1);
            distortion = cv::Mat::zeros(4, 1, CV_64F);
            cv::fisheye::calibrate(board, pixels, size, k, distortion, turns, shifts,
                                   cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
                                       cv::fisheye::CALIB_USE_INTRINSIC_GUESS,
                                   until);
        } else {
            std::vector<int> tried{0};
            if (lens == LensModel::pinhole)
                tried = {cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST};
            // Three terms above and three below often cancel each other but for a pole within the picture: then fewer.
            if (lens == LensModel::rational)
                tried = {cv::CALIB_RATIONAL_MODEL, cv::CALIB_RATIONAL_MODEL | cv::CALIB_FIX_K6,
                         cv::CALIB_RATIONAL_MODEL | cv::CALIB_FIX_K6 | cv::CALIB_FIX_K5};
            for (int const flags : tried) {
                k = distortion = cv::Mat();
                cv::calibrateCamera(board, pixels, size, k, distortion, turns, shifts, flags, until);
                if (has_rays(camera_of(lens, size_px, k, distortion))) break;
            }
        }
    } catch (cv::Exception const& e) {
        throw gi::InputError("no " + name_of(lens) + " lens fits the views", e.err,
                             "take more views, tilted and from different distances");
    }
    out.camera = camera_of(lens, size_px, k, distortion);
    for (double const v : parameters_of(out.camera))
        if (!std::isfinite(v))
            throw gi::InputError("no " + name_of(lens) + " lens fits the views", "its parameters are not finite",
                                 "take more views, tilted and from different distances");
    for (std::size_t i = 0; i < views.size(); ++i) {
        cv::Mat turn, shift;
        turns[i].reshape(1, 3).convertTo(turn, CV_64F);
        shifts[i].reshape(1, 3).convertTo(shift, CV_64F);
        out.poses.push_back(pose_of(cv::Vec3d(turn), cv::Vec3d(shift)));
    }
    return out;
}

void add_warnings(LensCalibration& c, std::vector<BoardView> const& used)
{
    if (used.size() < 8) c.warnings.push_back(fmt::format("only {} views: 10 to 20 are usual", used.size()));
    if (c.coverage < 0.6)
        c.warnings.push_back(fmt::format(
            "the views cover {:.0f} % of the picture: distortion is guessed elsewhere", 100 * c.coverage));
    double tilt = 0, nearest = 1e30, farthest = 0;
    for (ViewResult const& v : c.views) {
        if (!v.used) continue;
        double const cosine = std::abs((v.camera_from_board.rotation * glm::dvec3(0, 0, 1)).z);
        tilt = std::max(tilt, glm::degrees(std::acos(std::min(1., cosine))));
        nearest = std::min(nearest, glm::length(v.camera_from_board.position));
        farthest = std::max(farthest, glm::length(v.camera_from_board.position));
    }
    if (tilt < 20)
        c.warnings.push_back(
            fmt::format("no view is tilted by more than {:.0f} degrees: focal length and distance "
                        "cannot be told apart",
                        tilt));
    if (farthest < 1.2 * nearest) c.warnings.emplace_back("all views are from nearly the same distance");
    double const f_error = c.standard_deviations[0] / c.camera.fx;
    if (f_error > 0.005)
        c.warnings.push_back(fmt::format("the focal length is known to {:.1f} % only", 100 * f_error));
    try {
        check(c.camera, "the calibration");
    } catch (gi::InputError const& e) {
        c.warnings.emplace_back(e.what());
    }
}

} // namespace

int LensCalibration::used_views() const
{
    return int(std::count_if(views.begin(), views.end(), [](ViewResult const& v) { return v.used; }));
}

std::vector<std::string> parameter_names(LensModel lens)
{
    std::vector<std::string> names{"fx", "fy", "cx", "cy"};
    static char const* const brown[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
    static char const* const fisheye[] = {"k1", "k2", "k3", "k4"};
    for (int i = 0; i < coefficient_count(lens); ++i)
        names.emplace_back(lens == LensModel::fisheye ? fisheye[i] : brown[i]);
    return names;
}

std::vector<double> parameters_of(CameraModel const& c)
{
    std::vector<double> v{c.fx, c.fy, c.cx, c.cy};
    for (int i = 0; i < coefficient_count(c.lens); ++i) v.push_back(c.distortion[std::size_t(i)]);
    return v;
}

CameraModel with_parameters(CameraModel c, std::vector<double> const& v)
{
    c.fx = v.at(0);
    c.fy = v.at(1);
    c.cx = v.at(2);
    c.cy = v.at(3);
    for (std::size_t i = 4; i < v.size(); ++i) c.distortion.at(i - 4) = v[i];
    return c;
}

cv::Mat covariance_of(CameraModel const& camera, std::vector<BoardView> const& views,
                      std::vector<gi::RigidPose> const& poses)
{
    auto const values = parameters_of(camera);
    int const n = int(values.size());
    cv::Mat normal = cv::Mat::zeros(n, n, CV_64F);
    double squares = 0, count = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        auto const r = residuals(camera, poses[v], views[v]);
        cv::Mat slopes(2 * int(r.size()), n + 6, CV_64F);
        auto const fill = [&](int column, std::vector<glm::dvec2> const& plus,
                              std::vector<glm::dvec2> const& minus, double h) {
            for (std::size_t i = 0; i < r.size(); ++i)
                for (int k = 0; k < 2; ++k)
                    slopes.at<double>(int(2 * i) + k, column) = (plus[i][k] - minus[i][k]) / (2 * h);
        };
        for (int k = 0; k < n; ++k) {
            double const h = k < 4 ? 1e-3 : 1e-6;
            auto up = values, down = values;
            up[std::size_t(k)] += h;
            down[std::size_t(k)] -= h;
            fill(k, residuals(with_parameters(camera, up), poses[v], views[v]),
                 residuals(with_parameters(camera, down), poses[v], views[v]), h);
        }
        for (int k = 0; k < 6; ++k) {
            double const h = 1e-6;
            auto const moved = [&](double by) {
                cv::Vec3d turn, shift;
                (k < 3 ? turn : shift)[k % 3] = by;
                gi::RigidPose const d = pose_of(turn, shift);
                return gi::RigidPose{poses[v].position + d.position,
                                     glm::normalize(d.rotation * poses[v].rotation)};
            };
            fill(n + k, residuals(camera, moved(h), views[v]), residuals(camera, moved(-h), views[v]), h);
        }
        cv::Mat const all = slopes.t() * slopes;
        cv::Mat const cross = all(cv::Rect(n, 0, 6, n)), pose = all(cv::Rect(n, n, 6, 6));
        normal += all(cv::Rect(0, 0, n, n)) - cross * pose.inv(cv::DECOMP_SVD) * cross.t(); // poses eliminated
        for (auto const& d : r) squares += glm::dot(d, d);
        count += 2. * double(r.size()) - 6;
    }
    // Parameters differ by many powers of ten.
    cv::Mat scale = cv::Mat::zeros(n, n, CV_64F);
    for (int k = 0; k < n; ++k) scale.at<double>(k, k) = 1 / std::sqrt(std::max(1e-300, normal.at<double>(k, k)));
    cv::Mat const inverse = (scale * normal * scale).operator cv::Mat().inv(cv::DECOMP_SVD);
    return scale * inverse * scale * (squares / std::max(1., count - n));
}

double coverage_of(std::vector<BoardView> const& views, glm::ivec2 size_px)
{
    std::array<bool, 48> seen{};
    for (BoardView const& v : views)
        for (auto const& p : v.pixels) {
            int const x = std::clamp(int((p.x + 0.5) / size_px.x * 8), 0, 7);
            int const y = std::clamp(int((p.y + 0.5) / size_px.y * 6), 0, 5);
            seen[std::size_t(8 * y + x)] = true;
        }
    return double(std::count(seen.begin(), seen.end(), true)) / double(seen.size());
}

LensCalibration calibrate_lens(std::vector<BoardView> const& views, glm::ivec2 size_px, LensModel lens,
                               LensOptions const& options)
{
    LensCalibration out;
    std::vector<std::size_t> used;
    for (BoardView const& v : views) {
        ViewResult r;
        r.name = v.name;
        r.used = v.pixels.size() >= kFewestPoints;
        if (r.used)
            used.push_back(out.views.size());
        else
            r.why = fmt::format("it has {} points; {} are needed", v.pixels.size(), kFewestPoints);
        out.views.push_back(std::move(r));
    }
    std::size_t const most_outliers = used.size() / 3;
    Fit best;
    for (std::size_t dropped = 0;; ++dropped) {
        if (used.size() < kFewestViews)
            throw gi::InputError(fmt::format("{} of {} views can be used", used.size(), views.size()),
                                 fmt::format("{} are needed, each with {} points", kFewestViews, kFewestPoints),
                                 "take more pictures of the board");
        std::vector<BoardView const*> chosen;
        for (std::size_t i : used) chosen.push_back(&views[i]);
        best = fit(chosen, size_px, lens);
        std::vector<double> errors;
        for (std::size_t i = 0; i < used.size(); ++i)
            errors.push_back(rms(residuals(best.camera, best.poses[i], *chosen[i])));
        auto const worst = std::size_t(std::max_element(errors.begin(), errors.end()) - errors.begin());
        double const limit = std::max(options.outlier_floor_px, options.outlier_factor * gi::median(errors));
        if (!(options.outlier_factor > 0) || errors[worst] <= limit || dropped >= most_outliers ||
            used.size() <= kFewestViews)
            break;
        ViewResult& r = out.views[used[worst]];
        r.used = false;
        r.why = fmt::format("its error of {:.2f} px is {:.1f} times the median", errors[worst],
                            errors[worst] / gi::median(errors));
        used.erase(used.begin() + std::ptrdiff_t(worst));
    }
    out.camera = best.camera;
    std::vector<BoardView> chosen;
    double squares = 0, count = 0;
    for (std::size_t k = 0; k < used.size(); ++k) {
        ViewResult& r = out.views[used[k]];
        r.camera_from_board = best.poses[k];
        r.residuals_px = residuals(out.camera, r.camera_from_board, views[used[k]]);
        r.rms_px = rms(r.residuals_px);
        squares += r.rms_px * r.rms_px * double(r.residuals_px.size());
        count += double(r.residuals_px.size());
        chosen.push_back(views[used[k]]);
    }
    for (std::size_t i = 0; i < views.size(); ++i) { // poses of views left out, under the lens of the others
        ViewResult& r = out.views[i];
        auto const pose = r.used ? std::nullopt : camera_from_board(out.camera, views[i]);
        if (!pose) continue;
        r.camera_from_board = *pose;
        r.residuals_px = residuals(out.camera, *pose, views[i]);
        r.rms_px = rms(r.residuals_px);
    }
    out.rms_px = std::sqrt(squares / count);
    out.parameters = parameter_names(lens);
    out.covariance = covariance_of(out.camera, chosen, best.poses);
    for (int i = 0; i < out.covariance.rows; ++i)
        out.standard_deviations.push_back(std::sqrt(std::max(0., out.covariance.at<double>(i, i))));
    out.coverage = coverage_of(chosen, size_px);
    add_warnings(out, chosen);
    return out;
}

} // namespace ar
