#include "ar/calibration/sensor.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

/// Normalised radius: 0 at the centre, 1 at the corners.
double radius_squared(cv::Size size, double x, double y)
{
    double const dx = x + 0.5 - 0.5 * size.width, dy = y + 0.5 - 0.5 * size.height;
    return 4 * (dx * dx + dy * dy) / (double(size.width) * size.width + double(size.height) * size.height);
}

bool is_clipped(std::uint8_t v) { return v <= 2 || v >= 253; }

double unit_of(Photometry const& p, std::size_t channel, std::uint8_t byte)
{
    return p.unit_of_byte[channel][byte];
}

void check_pictures(std::span<cv::Mat const> rgb, std::string const& what)
{
    for (cv::Mat const& p : rgb)
        if (p.empty() || p.type() != CV_8UC3 || p.size() != rgb[0].size())
            throw gi::InputError(what + ": a picture is of another kind or size", "pixels are compared one by one",
                                 "take RGB pictures of one camera");
    if (rgb.empty()) throw gi::InputError(what + ": there is no picture", "the fit needs pictures", "take some");
}

cv::Vec3d lab_of(cv::Vec3d const& linear)
{
    cv::Matx33d const xyz(0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920,
                          0.9503041);
    cv::Vec3d const white(0.95047, 1, 1.08883);
    cv::Vec3d f = xyz * linear;
    for (int i = 0; i < 3; ++i) {
        double const t = f[i] / white[i];
        f[i] = t > 216. / 24389 ? std::cbrt(t) : (24389. / 27 * t + 16) / 116;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

} // namespace

VignettingFit vignetting_of_flat(std::span<cv::Mat const> rgb, Photometry const& response)
{
    check_pictures(rgb, "pictures of a flat field");
    // Use means of blocks: less noise, and equal weight for every part of the picture.
    constexpr int kBlocks = 24;
    struct Sample {
        double r2, unit;
        int level;
    };
    std::vector<Sample> samples;
    int levels = 0;
    cv::Size const size = rgb[0].size();
    for (cv::Mat const& p : rgb)
        for (std::size_t c = 0; c < 3; ++c, ++levels)
            for (int by = 0; by < kBlocks; ++by)
                for (int bx = 0; bx < kBlocks; ++bx) {
                    double sum = 0, r2 = 0;
                    int count = 0, clipped = 0;
                    for (int y = by * size.height / kBlocks; y < (by + 1) * size.height / kBlocks; ++y)
                        for (int x = bx * size.width / kBlocks; x < (bx + 1) * size.width / kBlocks; ++x) {
                            auto const v = p.at<cv::Vec3b>(y, x)[int(c)];
                            clipped += is_clipped(v);
                            sum += unit_of(response, c, v);
                            r2 += radius_squared(size, x, y);
                            ++count;
                        }
                    if (count > 0 && clipped == 0 && sum > 0) samples.push_back({r2 / count, sum / count, levels});
                }
    if (samples.size() < 100)
        throw gi::InputError(fmt::format("{} parts of the flat field can be used", samples.size()),
                             "the others are clipped", "expose it to the middle of the range");
    double furthest = 0;
    for (Sample const& s : samples) furthest = std::max(furthest, std::sqrt(s.r2));
    if (furthest < 0.8)
        throw gi::InputError(
            fmt::format("the unclipped part of the flat field reaches to radius {:.2f}", furthest),
            "the curve is fitted up to 1, the corners", "expose it so that the corners are in range");
    // unit = level (1 + a r2 + b r4 + c r6): linear in a, b, c for fixed levels, and vice versa.
    VignettingFit fit;
    std::vector<double> level(std::size_t(levels), 0);
    for (int round = 0; round < 30; ++round) {
        auto const falloff = [&](double r2) {
            return 1 + r2 * (fit.vignetting[0] + r2 * (fit.vignetting[1] + r2 * fit.vignetting[2]));
        };
        std::vector<double> up(level.size(), 0), down(level.size(), 0);
        for (Sample const& s : samples) {
            up[std::size_t(s.level)] += s.unit * falloff(s.r2);
            down[std::size_t(s.level)] += falloff(s.r2) * falloff(s.r2);
        }
        for (std::size_t i = 0; i < level.size(); ++i) level[i] = down[i] > 0 ? up[i] / down[i] : 1;
        // The scale of all levels is a fourth unknown; without it, the alternation would converge slowly.
        cv::Mat rows(int(samples.size()), 4, CV_64F), right(int(samples.size()), 1, CV_64F);
        for (int i = 0; i < rows.rows; ++i) {
            Sample const& s = samples[std::size_t(i)];
            for (int k = 0; k < 4; ++k) rows.at<double>(i, k) = std::pow(s.r2, k);
            right.at<double>(i) = s.unit / level[std::size_t(s.level)];
        }
        cv::Mat x;
        cv::solve(rows, right, x, cv::DECOMP_SVD);
        std::array<double, 3> const before = fit.vignetting;
        for (int k = 0; k < 3; ++k) fit.vignetting[std::size_t(k)] = x.at<double>(k + 1) / x.at<double>(0);
        cv::Mat const left = right - rows * x;
        fit.rms = std::sqrt(left.dot(left) / rows.rows);
        double change = 0;
        for (std::size_t k = 0; k < 3; ++k) change = std::max(change, std::abs(fit.vignetting[k] - before[k]));
        if (change < 1e-9) break;
    }
    for (Sample const& s : samples) fit.points.emplace_back(std::sqrt(s.r2), s.unit / level[std::size_t(s.level)]);
    return fit;
}

double NoiseModel::sigma(double unit) const { return std::sqrt(std::max(0., read + photon * std::max(0., unit))); }

NoiseFit noise_of_pairs(std::span<cv::Mat const> rgb, Photometry const& response)
{
    check_pictures(rgb, "pairs of frames");
    if (rgb.size() % 2 != 0)
        throw gi::InputError(fmt::format("{} frames", rgb.size()), "they are compared in pairs", "leave out one");
    struct Bin {
        double sum = 0, squares = 0, rounding = 0;
        std::size_t count = 0;
    };
    for (std::size_t k = 0; k < rgb.size(); k += 2)
        if (cv::norm(rgb[k], rgb[k + 1], cv::NORM_INF) == 0)
            throw gi::InputError(fmt::format("the frames of pair {} do not differ", k / 2 + 1),
                                 "every sensor has noise", "take two pictures, not one twice");
    std::map<int, Bin> bins; // of the pair's mean byte in steps of two
    for (std::size_t k = 0; k < rgb.size(); k += 2)
        for (int y = 0; y < rgb[k].rows; ++y)
            for (int x = 0; x < rgb[k].cols; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    auto const a = rgb[k].at<cv::Vec3b>(y, x)[int(c)], b = rgb[k + 1].at<cv::Vec3b>(y, x)[int(c)];
                    if (a <= 8 || b <= 8 || a >= 245 || b >= 245) continue; // noise must not be clipped
                    double const u = unit_of(response, c, a), v = unit_of(response, c, b);
                    int const byte = (a + b) / 2;
                    double const slope = 0.25 * (unit_of(response, c, std::uint8_t(byte + 2)) -
                                                 unit_of(response, c, std::uint8_t(byte - 2)));
                    Bin& bin = bins[(a + b) / 4];
                    bin.sum += 0.5 * (u + v);
                    bin.squares += 0.5 * (u - v) * (u - v);
                    bin.rounding += slope * slope / 12;
                    ++bin.count;
                }
    // Weighted least squares of variances; the relative standard error of a variance of n values is sqrt(2 / n).
    struct Point {
        double unit, variance, count;
    };
    std::vector<Point> points;
    for (auto const& [byte, bin] : bins) {
        auto const n = double(bin.count);
        double const unit = bin.sum / n, variance = (bin.squares - bin.rounding) / n;
        double const reach = 4 * std::sqrt(std::max(0., variance)); // of the values that were not left out
        if (bin.count >= 200 && unit - reach > unit_of(response, 1, 8) && unit + reach < unit_of(response, 1, 245))
            points.push_back({unit, variance, n});
    }
    NoiseFit fit;
    NoiseModel& model = fit.noise;
    if (points.size() < 5)
        throw gi::InputError(fmt::format("the frames have {} brightnesses that occur often", points.size()),
                             "noise is fitted over them", "take a scene with dark and bright parts, at rest");
    for (int round = 0; round < 20; ++round) {
        cv::Matx22d normal = cv::Matx22d::zeros();
        cv::Vec2d right(0, 0);
        for (auto const& p : points) {
            double const expected =
                round == 0 ? std::max(p.variance, 1e-12) : std::max(model.read + model.photon * p.unit, 1e-12);
            double const w = p.count / (expected * expected);
            normal += w * cv::Matx22d(1, p.unit, p.unit, p.unit * p.unit);
            right += w * cv::Vec2d(p.variance, p.unit * p.variance);
        }
        cv::Vec2d const x = normal.inv(cv::DECOMP_SVD) * right;
        model.read = std::max(0., x[0]);
        model.photon = std::max(0., x[1]);
    }
    double sum = 0;
    for (auto const& p : points)
        sum += std::pow(p.variance / std::max(1e-12, model.read + model.photon * p.unit) - 1, 2);
    fit.rms = std::sqrt(sum / double(points.size()));
    for (auto const& p : points) fit.points.emplace_back(p.unit, p.variance);
    return fit;
}

std::array<cv::Vec3f, 24> const& chart_linear_rgb()
{
    static std::array<cv::Vec3f, 24> const linear = [] {
        constexpr int bytes[24][3] = {
            {115, 82, 68},   {194, 150, 130}, {98, 122, 157},  {87, 108, 67},   {133, 128, 177}, {103, 189, 170},
            {214, 126, 44},  {80, 91, 166},   {193, 90, 99},   {94, 60, 108},   {157, 188, 64},  {224, 163, 46},
            {56, 61, 150},   {70, 148, 73},   {175, 54, 60},   {231, 199, 31},  {187, 86, 149},  {8, 133, 161},
            {243, 243, 242}, {200, 200, 200}, {160, 160, 160}, {122, 122, 121}, {85, 85, 85},    {52, 52, 52}};
        Photometry const srgb = srgb_photometry();
        std::array<cv::Vec3f, 24> out;
        for (std::size_t i = 0; i < 24; ++i)
            for (int c = 0; c < 3; ++c) out[i][c] = srgb.unit_of_byte[0][std::size_t(bytes[i][c])];
        return out;
    }();
    return linear;
}

ColourFit fit_colour(std::span<cv::Vec3f const> camera, std::span<cv::Vec3f const> chart)
{
    if (camera.size() < 6 || camera.size() != chart.size())
        throw gi::InputError(fmt::format("{} patches seen and {} known", camera.size(), chart.size()),
                             "six or more are needed, each known", "give the positions of all patches");
    int const n = int(camera.size());
    cv::Mat seen(n, 3, CV_64F), known(n, 3, CV_64F);
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c) {
            seen.at<double>(i, c) = camera[std::size_t(i)][c];
            known.at<double>(i, c) = chart[std::size_t(i)][c];
        }
    cv::SVD const svd(seen, cv::SVD::NO_UV);
    if (!(svd.w.at<double>(2) > 5e-3 * svd.w.at<double>(0)))
        throw gi::InputError("the patches seen do not span colours", "they do not determine a matrix",
                             "check the patches' positions");
    cv::Mat transposed;
    cv::solve(seen, known, transposed, cv::DECOMP_SVD);
    // The chart's illumination is no property of the camera: fit the brightness alone, by least squares.
    double const brightness = seen.dot(known) / seen.dot(seen);
    ColourFit fit;
    double before = 0;
    for (int i = 0; i < n; ++i) {
        cv::Vec3d const s(seen.at<double>(i, 0), seen.at<double>(i, 1), seen.at<double>(i, 2));
        cv::Vec3d const k(known.at<double>(i, 0), known.at<double>(i, 1), known.at<double>(i, 2));
        cv::Vec3d mapped(0, 0, 0);
        for (int c = 0; c < 3; ++c)
            for (int j = 0; j < 3; ++j) mapped[c] += transposed.at<double>(j, c) * s[j];
        fit.delta_e.push_back(cv::norm(lab_of(mapped) - lab_of(k)));
        fit.mean_delta_e += fit.delta_e.back() / n;
        before += cv::norm(lab_of(brightness * s) - lab_of(k)) / n;
    }
    fit.delta_e_before = before;
    if (fit.mean_delta_e > 10)
        throw gi::InputError(fmt::format("the patches are off by delta E {:.0f} on the mean", fit.mean_delta_e),
                             "no matrix maps them to the chart's colours",
                             "check the patches' positions and order");
    fit.brightness = brightness;
    fit.largest_delta_e = *std::max_element(fit.delta_e.begin(), fit.delta_e.end());
    for (int c = 0; c < 3; ++c)
        for (int j = 0; j < 3; ++j) fit.colour(c, j) = float(transposed.at<double>(j, c) / brightness);
    return fit;
}

std::vector<cv::Point2d> chart_centres(std::array<cv::Point2d, 4> const& corners_px, CameraModel const& camera)
{
    constexpr int kPatchColumns = 6, kPatchRows = 4;
    std::array<cv::Point2f, 4> seen;
    double turns = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        auto const d = direction_of(camera, {corners_px[i].x, corners_px[i].y});
        if (!d || d->z < 1e-3)
            throw gi::InputError(
                fmt::format("the lens sees nothing at ({:.1f}, {:.1f})", corners_px[i].x, corners_px[i].y),
                "a patch's centre has to be in the picture", "give pixels of this picture");
        seen[i] = cv::Point2f(float(d->x / d->z), float(d->y / d->z));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        cv::Point2f const u = seen[(i + 1) % 4] - seen[i], v = seen[(i + 2) % 4] - seen[(i + 1) % 4];
        double const turn = u.cross(v);
        if (turn == 0 || turns * turn < 0)
            throw gi::InputError("the corner patches are not the corners of a chart",
                                 "they are given one after the other around it",
                                 "give dark skin, bluish green, black and white, in this order");
        turns = turn;
    }
    std::array<cv::Point2f, 4> const chart{
        cv::Point2f(0, 0), {kPatchColumns - 1, 0}, {kPatchColumns - 1, kPatchRows - 1}, {0, kPatchRows - 1}};
    cv::Matx33d const seen_from_chart = cv::getPerspectiveTransform(chart.data(), seen.data());
    std::vector<cv::Point2d> centres;
    for (int row = 0; row < kPatchRows; ++row)
        for (int column = 0; column < kPatchColumns; ++column) {
            cv::Vec3d const p = seen_from_chart * cv::Vec3d(column, row, 1);
            auto const px = project(camera, {p[0] / p[2], p[1] / p[2], 1});
            if (!px)
                throw gi::InputError("the lens does not see the whole chart", "patches lie between the corners",
                                     "check the corners");
            centres.emplace_back(px->x, px->y);
        }
    return centres;
}

std::vector<cv::Vec3f> patch_units(cv::Mat const& rgb, std::span<cv::Point2d const> centres, double half_px,
                                   Photometry const& photometry)
{
    check_pictures({&rgb, 1}, "a picture of a chart");
    auto const& g = photometry.vignetting;
    std::vector<cv::Vec3f> out;
    for (cv::Point2d const& at : centres) {
        auto const fail = [&](std::string const& why) {
            throw gi::InputError(
                fmt::format("patch {} at ({:.1f}, {:.1f}) cannot be read", out.size() + 1, at.x, at.y), why,
                "check the position, its size and the exposure");
        };
        if (!(at.x - half_px >= 0 && at.y - half_px >= 0 && at.x + half_px <= rgb.cols - 1 &&
              at.y + half_px <= rgb.rows - 1 && half_px >= 0))
            fail("it reaches beyond the picture");
        cv::Vec3d sum(0, 0, 0);
        int count = 0;
        for (int y = int(std::ceil(at.y - half_px)); y <= int(at.y + half_px); ++y)
            for (int x = int(std::ceil(at.x - half_px)); x <= int(at.x + half_px); ++x) {
                double const r2 = radius_squared(rgb.size(), x, y);
                double const falloff = 1 + r2 * (g[0] + r2 * (g[1] + r2 * g[2]));
                for (std::size_t c = 0; c < 3; ++c) {
                    auto const v = rgb.at<cv::Vec3b>(y, x)[int(c)];
                    if (v == 255) fail("a pixel is clipped");
                    sum[int(c)] += unit_of(photometry, c, v) / falloff;
                }
                ++count;
            }
        if (count == 0) fail("no pixel is in it");
        out.emplace_back(cv::Vec3f(sum * (1. / count)));
    }
    return out;
}

} // namespace ar
