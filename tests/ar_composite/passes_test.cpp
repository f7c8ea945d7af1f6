// The parts of composites: they add up, also where a renderer gave no numbers.

#include "ar/composite/passes.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

TEST(Passes, OfPixelsThatAreNotFiniteAreTheCameras)
{
    cv::Size const size(8, 4);
    RenderedPair pair{random_radiance(size, 1), random_radiance(size, 2),
                      cv::Mat(size, CV_32FC1, cv::Scalar(0.5))};
    pair.direct = 0.4 * pair.with;
    pair.with.at<cv::Vec3f>(0, 1)[1] = NAN;
    pair.without.at<cv::Vec3f>(1, 2)[0] = INFINITY;
    pair.direct.at<cv::Vec3f>(2, 3)[2] = NAN;
    pair.with.at<cv::Vec3f>(3, 4) = {INFINITY, 0, 0};
    pair.coverage.at<float>(3, 4) = 0;
    pair.coverage.at<float>(3, 5) = NAN;
    pair.coverage.at<float>(3, 6) = 1; // what is behind does not matter
    pair.without.at<cv::Vec3f>(3, 6)[0] = NAN;
    cv::Mat const camera = camera_frame(size);
    cv::Mat written;
    Compositor compositor(srgb_photometry());
    ASSERT_EQ(compositor(camera, pair, {}, written).not_finite, 5u);
    CompositePasses const p = passes_of(compositor, camera, written, pair, {});
    for (cv::Mat const* pass :
         {&p.composite, &p.background, &p.objects, &p.added, &p.noise, &p.shadow, &p.indirect})
        EXPECT_TRUE(cv::checkRange(*pass));
    for (cv::Point const at :
         {cv::Point(1, 0), cv::Point(2, 1), cv::Point(3, 2), cv::Point(4, 3), cv::Point(5, 3)}) {
        EXPECT_EQ(p.objects.at<cv::Vec4f>(at), cv::Vec4f(0, 0, 0, 0)) << at;
        EXPECT_EQ(p.added.at<cv::Vec3f>(at), cv::Vec3f(0, 0, 0)) << at;
    }
    EXPECT_EQ(p.objects.at<cv::Vec4f>(3, 6)[3], 1);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            cv::Vec4f const o = p.objects.at<cv::Vec4f>(y, x);
            cv::Vec3f const sum = cv::Vec3f(o[0], o[1], o[2]) + (1 - o[3]) * p.background.at<cv::Vec3f>(y, x) +
                                  p.added.at<cv::Vec3f>(y, x) + p.noise.at<cv::Vec3f>(y, x);
            EXPECT_LT(cv::norm(sum - p.composite.at<cv::Vec3f>(y, x)), 1e-5) << x << " " << y;
        }
}

} // namespace
} // namespace ar::test
