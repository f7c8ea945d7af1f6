#include "ar/composite/occluders.h"

#include "ar/composite/composite.h"
#include "tests/ar_composite/test_pictures.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

cv::Mat flat(cv::Size size, float v) { return cv::Mat(size, CV_32FC1, cv::Scalar(v)); }

TEST(Occluders, HideWhatIsBehindAndNothingElse)
{
    cv::Size const size(40, 20);
    cv::Mat const camera = camera_frame(size);
    RenderedPair pair{random_radiance(size, 1), random_radiance(size, 2), flat(size, 0.7f),
                      random_radiance(size, 3, 0, 0.1)};
    cv::Mat measured = flat(size, 3); // behind all
    measured(cv::Rect(10, 0, 10, 20)) = 0.5;
    measured(cv::Rect(30, 0, 5, 20)) = 0; // holes
    cv::Mat modelled = flat(size, 1);
    Compositor composite(srgb_photometry());
    cv::Mat before, after;
    composite(camera, pair, {}, before);
    OcclusionCounts counts;
    occlude(pair, share_of_nearer(measured, modelled, {.soft_px = 0}), measured, counts);
    composite(camera, pair, {}, after);
    EXPECT_EQ(counts.hidden, 200u);
    EXPECT_EQ(counts.holes, 100u);
    for (int x = 0; x < size.width; ++x)
        EXPECT_TRUE(equal(after.col(x), (x >= 10 && x < 20 ? camera : before).col(x))) << x;
}

TEST(Occluders, AreSoftByDepthAndAtBorders)
{
    cv::Mat measured(1, 7, CV_32FC1), modelled(1, 7, CV_32FC1, cv::Scalar(1));
    float const z[]{1.1f, 0.981f, 0.97f, 0.95f, 0.9f, NAN, 0.5f};
    std::copy(std::begin(z), std::end(z), measured.ptr<float>());
    modelled.at<float>(0, 6) = 0; // nothing there: as beside it
    cv::Mat const share = share_of_nearer(measured, modelled, {.margin_m = 0.02, .soft_m = 0.02, .soft_px = 0});
    EXPECT_EQ(share.at<float>(0, 0), 0);
    EXPECT_EQ(share.at<float>(0, 1), 0);
    EXPECT_NEAR(share.at<float>(0, 2), 0.5, 1e-3);
    EXPECT_EQ(share.at<float>(0, 3), 1);
    EXPECT_EQ(share.at<float>(0, 5), 0);
    EXPECT_EQ(share.at<float>(0, 6), 1);
    EXPECT_EQ(cv::countNonZero(share_of_nearer(flat({9, 9}, 5), flat({9, 9}, 0), {})), 0) << "nothing was added";
    cv::Mat wide = flat({20, 20}, 2);
    wide.colRange(10, 20) = 0.5;
    cv::Mat const soft = share_of_nearer(wide, flat({20, 20}, 1), {.soft_px = 1});
    EXPECT_GT(soft.at<float>(10, 9), 0.1f);
    EXPECT_LT(soft.at<float>(10, 9), 0.5f);
    EXPECT_EQ(soft.at<float>(10, 2), 0);
}

TEST(Occluders, MixTheCompositeWithTheCamera)
{
    cv::Size const size(50, 30);
    cv::Mat const camera = camera_frame(size);
    RenderedPair pair{random_radiance(size, 1), random_radiance(size, 2, 0, 0.3), flat(size, 0.4f)};
    CompositeSettings settings;
    settings.clipped = ClippedBytes::as_measured;
    Compositor composite(srgb_photometry(), settings);
    cv::Mat const all = composite.light(camera, pair, {});
    OcclusionCounts counts;
    occlude(pair, flat(size, 0.3f), {}, counts);
    cv::Mat const half = composite.light(camera, pair, {});
    cv::Mat const expected = 0.7 * all + 0.3 * radiance_of(camera, srgb_photometry());
    // Values below 0 are cut in both, at other places.
    int off = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int c = 0; c < 3; ++c)
                if (all.at<cv::Vec3f>(y, x)[c] > 0)
                    off += std::abs(half.at<cv::Vec3f>(y, x)[c] - expected.at<cv::Vec3f>(y, x)[c]) > 1e-5f;
    EXPECT_EQ(off, 0);
}

} // namespace
} // namespace ar::test
