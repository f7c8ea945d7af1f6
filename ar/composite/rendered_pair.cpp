#include "ar/composite/rendered_pair.h"

#include "gi/core/error.h"

#include <fmt/format.h>

namespace ar {

void check(RenderedPair const& pair, cv::Size size)
{
    if (size.empty()) size = pair.with.size();
    auto const require = [&](cv::Mat const& picture, int type, char const* name) {
        if (picture.type() == type && picture.size() == size && !picture.empty()) return;
        throw gi::InputError(
            fmt::format("the rendered picture '{}' has {} x {} pixels of type {}", name, picture.cols,
                        picture.rows, cv::typeToString(picture.type())),
            fmt::format("{} x {} of {} are needed", size.width, size.height, cv::typeToString(type)),
            "render at the frame's size, or bring it there with upsampled() or Warp");
    };
    require(pair.with, CV_32FC3, "with");
    require(pair.without, CV_32FC3, "without");
    require(pair.coverage, CV_32FC1, "coverage");
    if (!pair.direct.empty()) require(pair.direct, CV_32FC3, "direct");
}

RenderedPair faded(RenderedPair const& pair, double share)
{
    RenderedPair f;
    f.without = pair.without;
    cv::subtract(pair.with, pair.without, f.with);
    cv::scaleAdd(f.with, share, pair.without, f.with);
    f.coverage = share * pair.coverage;
    if (!pair.direct.empty()) f.direct = share * pair.direct;
    return f;
}

} // namespace ar
