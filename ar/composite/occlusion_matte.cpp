#include "ar/composite/occlusion_matte.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

void require(cv::Mat const& picture, int type, cv::Size size)
{
    if (picture.type() == type && picture.size() == size && !picture.empty()) return;
    throw gi::InputError("pictures for a matte have other sizes or types", "each pixel needs all of them",
                         "give coverages (CV_32FC1) and radiance (CV_32FC3) of the frame's size");
}

cv::Mat dilated(cv::Mat const& mask, int by)
{
    cv::Mat out;
    cv::dilate(mask, out, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * by + 1, 2 * by + 1}));
    return out;
}

/// v = colour . slope + offset, and the share of v's variance that this explains.
struct LinearModel {
    cv::Vec3d slope{0, 0, 0};
    double offset = 0, fit = 0;
};

/// Snaps values near 0 and 1, so that texture on one side does not make the other shine through.
double stretched(double v)
{
    constexpr double kGain = 1.3;
    return std::clamp(kGain * (v - 0.5) + 0.5, 0.0, 1.0);
}

/// Sums over a window of known pixels: weight, v, v^2, colour (3), colour v (3), colour colour (6).
using Sums = cv::Vec<double, 15>;

LinearModel fitted(Sums const& sums, double epsilon)
{
    double const n = sums[0];
    if (n < 8) return {};
    double const v = sums[1] / n, variance_v = sums[2] / n - v * v;
    if (!(variance_v > 1e-4)) return {}; // one side only
    cv::Vec3d const mean(sums[3] / n, sums[4] / n, sums[5] / n);
    cv::Vec3d const with_v = cv::Vec3d(sums[6], sums[7], sums[8]) / n - mean * v;
    cv::Matx33d c(sums[9], sums[10], sums[11], sums[10], sums[12], sums[13], sums[11], sums[13], sums[14]);
    c = c * (1 / n) - mean * mean.t();
    double const added = epsilon * cv::trace(c) / 3 + 1e-12;
    for (int i = 0; i < 3; ++i) c(i, i) += added;
    LinearModel m;
    m.slope = c.solve(with_v, cv::DECOMP_CHOLESKY);
    m.offset = v - m.slope.dot(mean);
    m.fit = std::clamp(m.slope.dot(with_v) / variance_v, 0.0, 1.0);
    return m;
}

} // namespace

cv::Mat refined_coverage(cv::Mat const& coverage, cv::Mat const& unoccluded, cv::Mat const& camera,
                         MatteSettings const& settings, MatteCounts* counts)
{
    cv::Size const size = camera.size();
    require(camera, CV_32FC3, size);
    require(coverage, CV_32FC1, size);
    require(unoccluded, CV_32FC1, size);
    if (settings.band_px < 1 || settings.radius_px <= settings.band_px)
        throw gi::InputError("a matte's windows must be larger than its band", "a model is fitted beside the band",
                             "choose radius_px > band_px >= 1");
    cv::Mat result = coverage.clone();
    cv::Mat const object = unoccluded > 0.5f;
    cv::Mat const hidden = object & cv::Mat(coverage < 0.5f * unoccluded), shown = object & ~hidden;
    cv::Mat const band = dilated(hidden, settings.band_px) & dilated(shown, settings.band_px) & (unoccluded > 0);
    cv::Rect const box = cv::boundingRect(band);
    if (counts) *counts = {std::size_t(cv::countNonZero(band)), 0};
    if (box.empty()) return result;
    int const r = settings.radius_px;
    cv::Rect const around =
        cv::Rect(box.x - 2 * r, box.y - 2 * r, box.width + 4 * r, box.height + 4 * r) & cv::Rect({0, 0}, size);

    // Integral of the sums over known pixels.
    cv::Mat const known = object & ~band;
    int const columns = around.width, rows = around.height;
    std::vector<Sums> integral(std::size_t(columns + 1) * std::size_t(rows + 1));
    auto const at = [&](int x, int y) -> Sums& {
        return integral[std::size_t(y) * std::size_t(columns + 1) + std::size_t(x)];
    };
    for (int y = 0; y < rows; ++y) {
        Sums row = Sums::all(0);
        for (int x = 0; x < columns; ++x) {
            cv::Point const p(around.x + x, around.y + y);
            cv::Vec3f const i = camera.at<cv::Vec3f>(p);
            if (known.at<uchar>(p) && std::isfinite(i[0] + i[1] + i[2])) {
                double const v = hidden.at<uchar>(p) ? 0 : 1, a = i[0], b = i[1], c = i[2];
                double const values[15] = {1,     v,     v * v, a,     b,     c,     a * v, b * v,
                                           c * v, a * a, a * b, a * c, b * b, b * c, c * c};
                row += Sums(values);
            }
            at(x + 1, y + 1) = at(x + 1, y) + row;
        }
    }
    // Models of windows whose centres are near the band, then their mean at each pixel of it (He et al., eq. 8),
    // weighted by how well they fit.
    cv::Mat const centres = dilated(band, r / 2);
    cv::Mat models(rows + 1, columns + 1, CV_64FC(5), cv::Scalar::all(0));
    using Weighted = cv::Vec<double, 5>; // fit times slope, offset, 1
    cv::parallel_for_({0, rows}, [&](cv::Range const& part) {
        for (int y = part.start; y < part.end; ++y)
            for (int x = 0; x < columns; ++x) {
                if (!centres.at<uchar>(around.y + y, around.x + x)) continue;
                int const x0 = std::max(x - r, 0), x1 = std::min(x + r + 1, columns);
                int const y0 = std::max(y - r, 0), y1 = std::min(y + r + 1, rows);
                LinearModel const m = fitted(at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0), settings.epsilon);
                models.at<Weighted>(y, x) = m.fit * Weighted(m.slope[0], m.slope[1], m.slope[2], m.offset, 1);
            }
    });
    cv::Mat mean, windows;
    cv::boxFilter(models, mean, -1, {r + 1, r + 1}, {-1, -1}, false, cv::BORDER_CONSTANT);
    cv::Mat centre_count;
    centres(around).convertTo(centre_count, CV_64F, 1 / 255.0);
    cv::boxFilter(centre_count, windows, -1, {r + 1, r + 1}, {-1, -1}, false, cv::BORDER_CONSTANT);
    std::size_t refined = 0;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            cv::Point const p(around.x + x, around.y + y);
            if (!band.at<uchar>(p)) continue;
            Weighted const m = mean.at<Weighted>(y, x);
            double const fit = m[4] / std::max(1.0, windows.at<double>(y, x));
            if (!(fit > settings.least_fit)) continue;
            cv::Vec3f const i = camera.at<cv::Vec3f>(p);
            double const v = (m[0] * i[0] + m[1] * i[1] + m[2] * i[2] + m[3]) / m[4];
            if (!std::isfinite(v)) continue;
            double const share =
                std::clamp((fit - settings.least_fit) / (settings.full_fit - settings.least_fit), 0.0, 1.0);
            float const before = result.at<float>(p);
            float const after = float(share * stretched(v) * unoccluded.at<float>(p) + (1 - share) * before);
            refined += after != before;
            result.at<float>(p) = after;
        }
    if (counts) counts->refined = refined;
    return result;
}

RenderedPair with_coverage(RenderedPair const& pair, cv::Mat const& coverage, DirectlySeen const& seen,
                           DirectlySeen const& unoccluded)
{
    check(pair);
    cv::Size const size = pair.with.size();
    require(coverage, CV_32FC1, size);
    require(seen.radiance, CV_32FC3, size);
    require(seen.coverage, CV_32FC1, size);
    require(unoccluded.radiance, CV_32FC3, size);
    require(unoccluded.coverage, CV_32FC1, size);
    RenderedPair out{pair.with.clone(), pair.without, coverage.clone(), seen.radiance.clone()};
    out.with.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
        float const a = pair.coverage.at<float>(at[0], at[1]), to = coverage.at<float>(at[0], at[1]);
        if (a == to) return;
        cv::Vec3f const without = pair.without.at<cv::Vec3f>(at[0], at[1]);
        cv::Vec3f place = without;
        if (a <= 0.5f) place = (v - seen.radiance.at<cv::Vec3f>(at[0], at[1])) * (1 / (1 - a));
        float const all = unoccluded.coverage.at<float>(at[0], at[1]);
        cv::Vec3f const object =
            all > 0 ? unoccluded.radiance.at<cv::Vec3f>(at[0], at[1]) * (to / all) : cv::Vec3f(0, 0, 0);
        v = object + (1 - to) * place;
        out.direct.at<cv::Vec3f>(at[0], at[1]) = object;
    });
    return out;
}

} // namespace ar
