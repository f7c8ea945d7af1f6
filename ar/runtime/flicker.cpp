#include "ar/runtime/flicker.h"

#include "ar/markers/marker_map_file.h"
#include "ar/runtime/runner.h"

#include <cmath>

namespace ar {
namespace {

constexpr int kBlock_px = 8;

/// Mean and standard deviation of each element over pictures.
struct Moments {
    cv::Mat first;        ///< CV_64F; differences from it are summed, so that equal pictures deviate by exactly 0
    cv::Mat sum, squares; ///< CV_64F
    int count = 0;

    void add(cv::Mat const& picture)
    {
        cv::Mat difference;
        picture.convertTo(difference, CV_64F);
        if (count++ == 0) {
            first = difference.clone();
            sum = cv::Mat::zeros(first.size(), first.type());
            squares = sum.clone();
        }
        difference -= first;
        sum += difference;
        squares += difference.mul(difference);
    }
    cv::Mat mean() const { return first + sum / count; }
    cv::Mat deviation() const
    {
        cv::Mat const shift = sum / count;
        cv::Mat variance = squares / count - shift.mul(shift), root;
        cv::sqrt(cv::max(variance, 0), root);
        return root;
    }
};

/// Mean luminance of each block, CV_64FC1; only whole blocks.
cv::Mat block_means(cv::Mat const& radiance)
{
    cv::Mat means(radiance.rows / kBlock_px, radiance.cols / kBlock_px, CV_64FC1);
    for (int y = 0; y < means.rows; ++y)
        for (int x = 0; x < means.cols; ++x) {
            cv::Scalar const m = cv::mean(radiance({kBlock_px * x, kBlock_px * y, kBlock_px, kBlock_px}));
            means.at<double>(y, x) = 0.2126 * m[0] + 0.7152 * m[1] + 0.0722 * m[2];
        }
    return means;
}

} // namespace

Flicker measure_flicker(Session const& session, Frame const& frame, gi::RigidPose const& pose, double time_s,
                        int frames, gi::StopRequest const& stop, gi::Report& report)
{
    gi::Report own; // counts of this run are not the session's
    Pipeline pipeline(session, load_camera(session.camera), read_marker_map(session.markers), own);
    Moments bytes, blocks;
    cv::Mat coverage, changed;
    for (int k = 0; k < frames && !stop.requested(); ++k) {
        FrameResult r = pipeline.find(frame, time_s, pose);
        pipeline.add(r, frame, time_s, stop);
        if (!r.pair) break;
        bytes.add(eight_bits_of(r.rgb));
        blocks.add(block_means(r.pair->with));
        coverage = k == 0 ? r.pair->coverage.clone() : cv::Mat(cv::min(coverage, r.pair->coverage));
        cv::Mat differs = r.rgb != r.camera;
        changed = k == 0 ? differs : cv::Mat(changed | differs);
    }
    for (auto const& [what, loss] : own.losses()) report.lose(what, loss.count, loss.first);
    Flicker f;
    f.frames = bytes.count;
    if (f.frames < 2) return f;
    cv::Mat const deviation = blocks.deviation(), mean = blocks.mean();
    for (int y = 0; y < mean.rows; ++y)
        for (int x = 0; x < mean.cols; ++x) {
            double least = 1;
            cv::minMaxLoc(coverage({kBlock_px * x, kBlock_px * y, kBlock_px, kBlock_px}), &least);
            if (least > 0.99 && mean.at<double>(y, x) > 0)
                f.blocks_percent.push_back(100 * deviation.at<double>(y, x) / mean.at<double>(y, x));
        }
    cv::Scalar const spread = cv::sum(bytes.deviation());
    double const values = double(cv::countNonZero(changed.reshape(1)));
    if (values > 0) f.bytes = (spread[0] + spread[1] + spread[2]) / values;
    return f;
}

} // namespace ar
