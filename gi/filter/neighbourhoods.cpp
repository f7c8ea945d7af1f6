#include "gi/filter/neighbourhoods.h"

#include "gi/filter/filter_input.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

namespace gi {

Neighbourhoods::Neighbourhoods(Layer const& l1, Layer const& albedo, int width, int height, bool few,
                               TemporalSettings const& settings)
    : l1_(l1),
      albedo_(albedo),
      width_(width),
      height_(height),
      window_(settings.window),
      spread_(settings.spread),
      few_(few)
{
    if (few) return;
    cv::Mat direct(height, width, CV_32FC3);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) direct.ptr<vec3>(y)[x] = direct_at(x, y);
    });
    cv::Size const size(window_, window_);
    cv::boxFilter(direct, mean_, CV_32F, size, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::sqrBoxFilter(direct, squares_, CV_32F, size, {-1, -1}, true, cv::BORDER_REPLICATE);
}

Neighbourhoods::Range Neighbourhoods::around(int x, int y) const
{
    vec3 mean{0}, squares{0};
    if (few_) {
        for (int j = -window_ / 2; j <= window_ / 2; ++j)
            for (int i = -window_ / 2; i <= window_ / 2; ++i) {
                vec3 const d = direct_at(std::clamp(x + i, 0, width_ - 1), std::clamp(y + j, 0, height_ - 1));
                mean += d;
                squares += d * d;
            }
        mean /= float(window_ * window_);
        squares /= float(window_ * window_);
    } else {
        mean = mean_.ptr<vec3>(y)[x];
        squares = squares_.ptr<vec3>(y)[x];
    }
    vec3 const deviation = spread_ * glm::sqrt(glm::max(vec3{0}, squares - mean * mean));
    return {mean - deviation, mean + deviation};
}

vec3 Neighbourhoods::direct_at(int x, int y) const
{
    std::size_t const i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
    return light_over(rgb(l1_, i), rgb(albedo_, i));
}

} // namespace gi
