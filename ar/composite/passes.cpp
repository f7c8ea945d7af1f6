#include "ar/composite/passes.h"

#include <algorithm>
#include <cmath>

namespace ar {

CompositePasses passes_of_nothing(Photometry const& photometry, cv::Mat const& camera, Exposure const& exposure)
{
    CompositePasses p;
    p.composite = p.background = radiance_of(camera, photometry, exposure);
    p.objects = cv::Mat::zeros(camera.size(), CV_32FC4);
    p.added = cv::Mat::zeros(camera.size(), CV_32FC3);
    p.noise = cv::Mat::zeros(camera.size(), CV_32FC3);
    p.indirect = cv::Mat::zeros(camera.size(), CV_32FC3);
    p.shadow = cv::Mat(camera.size(), CV_32FC3, cv::Scalar::all(1));
    return p;
}

CompositePasses passes_of(Compositor& compositor, cv::Mat const& camera, cv::Mat const& written,
                          RenderedPair const& pair, Exposure const& exposure)
{
    CompositePasses p = passes_of_nothing(compositor.photometry(), camera, exposure);
    p.composite = radiance_of(written, compositor.photometry(), exposure);
    cv::Mat const light = compositor.light(camera, pair, exposure);
    cv::parallel_for_({0, camera.rows}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < camera.cols; ++x) {
                float const a = std::clamp(pair.coverage.at<float>(y, x), 0.0f, 1.0f); // NaN stays
                cv::Vec3f const &with = pair.with.at<cv::Vec3f>(y, x), &without = pair.without.at<cv::Vec3f>(y, x);
                if ((a == 0 && with == without) || std::isnan(a)) continue;
                bool const is_parted = !pair.direct.empty() && a > 0 && a < 1;
                if (!is_finite(with) ||
                    (a < 1 && !(is_finite(without) && is_finite(p.background.at<cv::Vec3f>(y, x)))) ||
                    (is_parted && !is_finite(pair.direct.at<cv::Vec3f>(y, x))))
                    continue; // the compositor leaves the camera's
                // Without `direct`, all of a covered pixel's light counts as the objects'.
                cv::Vec3f direct = pair.direct.empty() ? (a > 0 ? with - (1 - a) * without : cv::Vec3f(0, 0, 0))
                                                       : pair.direct.at<cv::Vec3f>(y, x);
                if (a == 0) direct = {0, 0, 0};
                if (a >= 1) direct = with;
                cv::Vec3f const all = light.at<cv::Vec3f>(y, x), seen = p.background.at<cv::Vec3f>(y, x);
                p.objects.at<cv::Vec4f>(y, x) = {direct[0], direct[1], direct[2], a};
                p.added.at<cv::Vec3f>(y, x) = all - direct - (1 - a) * seen;
                p.noise.at<cv::Vec3f>(y, x) = p.composite.at<cv::Vec3f>(y, x) - all;
                if (a >= 1) continue;
                for (int c = 0; c < 3; ++c) {
                    float const place = (with[c] - direct[c]) / (1 - a), before = without[c];
                    p.indirect.at<cv::Vec3f>(y, x)[c] = (1 - a) * std::max(place - before, 0.0f);
                    if (before > 0 && place < before)
                        p.shadow.at<cv::Vec3f>(y, x)[c] = std::max(place / before, 0.0f);
                }
            }
    });
    return p;
}

} // namespace ar
