#include "ar/composite/occluders.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

bool is_depth(float z) { return z > 0 && std::isfinite(z); }

} // namespace

cv::Mat share_of_nearer(cv::Mat const& measured_m, cv::Mat const& modelled_m, DepthOcclusion const& s)
{
    CV_Assert(measured_m.type() == CV_32FC1 && modelled_m.type() == CV_32FC1 &&
              measured_m.size() == modelled_m.size());
    constexpr float kNone = 1e30f;
    cv::Mat filled = modelled_m.clone(), nearest;
    filled.forEach<float>([&](float& z, int const*) { z = is_depth(z) ? z : kNone; });
    // Beside objects, as far as the blur below reaches, the nearest of them decides.
    int const side = 2 * (2 + int(std::ceil(3 * s.soft_px))) + 1;
    cv::erode(filled, nearest, cv::getStructuringElement(cv::MORPH_RECT, {side, side})); // the least
    cv::Mat share(measured_m.size(), CV_32FC1);
    share.forEach<float>([&](float& o, int const* at) {
        float const d = measured_m.at<float>(at[0], at[1]), own = filled.at<float>(at[0], at[1]),
                    z = own < kNone ? own : nearest.at<float>(at[0], at[1]);
        o = 0;
        if (!is_depth(d) || !(z < kNone)) return;
        double const nearer_m = double(z) - d - s.margin_m;
        double const t = s.soft_m > 0 ? std::clamp(nearer_m / s.soft_m, 0.0, 1.0) : double(nearer_m > 0);
        o = float(t * t * (3 - 2 * t));
    });
    if (s.soft_px > 0) cv::GaussianBlur(share, share, {}, s.soft_px);
    return share;
}

void occlude(RenderedPair& pair, cv::Mat const& share, cv::Mat const& measured_m, OcclusionCounts& counts)
{
    CV_Assert(share.type() == CV_32FC1 && share.size() == pair.with.size());
    // The pair's pictures may be shared with others.
    for (cv::Mat* const m : {&pair.with, &pair.coverage, &pair.direct}) *m = m->clone();
    std::mutex adding;
    cv::parallel_for_({0, share.rows}, [&](cv::Range const& rows) {
        OcclusionCounts sum;
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < share.cols; ++x) {
                cv::Vec3f& with = pair.with.at<cv::Vec3f>(y, x);
                cv::Vec3f const& without = pair.without.at<cv::Vec3f>(y, x);
                float& a = pair.coverage.at<float>(y, x);
                if (a == 0 && with == without) continue;
                sum.holes += !measured_m.empty() && !is_depth(measured_m.at<float>(y, x));
                float const o = share.at<float>(y, x);
                if (!(o > 0)) continue;
                sum.hidden += a > 0 && o >= 0.5f;
                a *= 1 - o;
                if (!pair.direct.empty()) pair.direct.at<cv::Vec3f>(y, x) *= 1 - o;
                with = o >= 1 ? without : (1 - o) * with + o * without;
            }
        std::lock_guard const lock(adding);
        counts.holes += sum.holes;
        counts.hidden += sum.hidden;
    });
}

} // namespace ar
