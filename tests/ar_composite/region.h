#pragma once
// Where virtual objects changed a picture, and errors there and elsewhere.

#include "ar/composite/rendered_pair.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ar::test {

/// CV_8UC1: 255 where objects are seen, or where with and without differ by more than `threshold`
/// of without (of its largest channel, at least 1e-3 of the picture's mean); grown by `dilate_px`.
/// What is not finite is affected.
inline cv::Mat affected_region(RenderedPair const& pair, double threshold = 0.02, int dilate_px = 2)
{
    check(pair);
    double sum = 0;
    std::size_t finite = 0;
    for (int y = 0; y < pair.without.rows; ++y)
        for (int x = 0; x < pair.without.cols; ++x) {
            cv::Vec3f const v = pair.without.at<cv::Vec3f>(y, x);
            float const mean = (v[0] + v[1] + v[2]) / 3;
            if (!std::isfinite(mean)) continue;
            sum += mean;
            ++finite;
        }
    double const least = finite > 0 ? 1e-3 * sum / double(finite) : 0;
    cv::Mat region(pair.with.size(), CV_8UC1);
    region.forEach<uchar>([&](uchar& affected, int const* at) {
        cv::Vec3f const w = pair.with.at<cv::Vec3f>(at[0], at[1]), n = pair.without.at<cv::Vec3f>(at[0], at[1]);
        double const scale = std::max(least, double(std::max({n[0], n[1], n[2]})));
        bool same = pair.coverage.at<float>(at[0], at[1]) <= 0;
        for (int c = 0; c < 3; ++c) same = same && (w[c] == n[c] || std::abs(w[c] - n[c]) <= threshold * scale);
        affected = same ? 0 : 255;
    });
    if (dilate_px > 0)
        cv::dilate(region, region,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * dilate_px + 1, 2 * dilate_px + 1}));
    return region;
}

/// Of bytes, all channels.
struct RegionError {
    std::size_t pixels = 0;
    double mean_absolute = 0, rms = 0; ///< bytes; 0 without pixels
    int largest = 0;
    std::size_t differing = 0; ///< pixels
};

struct CompositeError {
    RegionError inside, outside;
};

/// @param a, b  CV_8UC3 @param region  CV_8UC1. @throws gi::InputError types or sizes
inline CompositeError errors_of(cv::Mat const& a, cv::Mat const& b, cv::Mat const& region)
{
    if (a.type() != CV_8UC3 || b.type() != CV_8UC3 || region.type() != CV_8UC1 || a.size() != b.size() ||
        a.size() != region.size())
        throw gi::InputError("pictures to compare have other sizes or types", "errors are of pixels",
                             "give two of RGB bytes and a mask, all of one size");
    CompositeError e;
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) {
            RegionError& r = region.at<uchar>(y, x) ? e.inside : e.outside;
            cv::Vec3b const p = a.at<cv::Vec3b>(y, x), q = b.at<cv::Vec3b>(y, x);
            for (int c = 0; c < 3; ++c) {
                int const d = std::abs(int(p[c]) - int(q[c]));
                r.mean_absolute += d;
                r.rms += d * d;
                r.largest = std::max(r.largest, d);
            }
            ++r.pixels;
            r.differing += p != q;
        }
    for (RegionError* r : {&e.inside, &e.outside})
        if (r->pixels > 0) {
            r->mean_absolute /= 3 * double(r->pixels);
            r->rms = std::sqrt(r->rms / (3 * double(r->pixels)));
        }
    return e;
}

} // namespace ar::test
