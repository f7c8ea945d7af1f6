#include "ar/pose/focal_check.h"

#include "tests/ar_pose/synthetic.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

std::vector<Sighting> views(CameraModel const& camera, double tilt_rad, double noise_px = 0.1)
{
    std::mt19937 random(5);
    std::vector<Sighting> all;
    for (int i = 0; i < 6; ++i) {
        double const turn = 0.9 * i;
        glm::dvec3 const eye = 0.7 * glm::dvec3(std::sin(tilt_rad) * std::cos(turn), std::cos(tilt_rad),
                                                std::sin(tilt_rad) * std::sin(turn));
        all.push_back(sight(marker_grid(), camera, looking(eye, {0, 0, 0}, 0.3 * i), noise_px, random));
    }
    return all;
}

CameraModel with_focal_length(CameraModel c, double scale)
{
    c.fx *= scale;
    c.fy *= scale;
    return c;
}

TEST(FocalCheck, FindsTheFocalLengthThatThePicturesShow)
{
    for (LensModel const lens : {LensModel::pinhole, LensModel::radial_tangential, LensModel::fisheye}) {
        CameraModel const camera = camera_640(lens);
        std::vector<Sighting> const seen = views(camera, 0.7);
        for (double const scale : {0.6, 0.8, 1.1, 1.26, 1.7}) {
            auto const finding = contradicted_focal_length(with_focal_length(camera, scale), seen);
            ASSERT_TRUE(finding) << name_of(lens) << " " << scale;
            EXPECT_NEAR(finding->scale * scale, 1, lens == LensModel::fisheye ? 0.05 : 0.03) << name_of(lens);
            EXPECT_LT(2 * finding->best_px, finding->own_px);
            EXPECT_EQ(finding->views, 6);
        }
    }
}

TEST(FocalCheck, IsSilentWhereThePicturesDoNotTell)
{
    CameraModel const camera = camera_640();
    EXPECT_FALSE(contradicted_focal_length(camera, views(camera, 0.7))) << "right";
    EXPECT_FALSE(contradicted_focal_length(with_focal_length(camera, 1.01), views(camera, 0.7))) << "nearly right";
    CameraModel const pinhole = camera_640(LensModel::pinhole);
    EXPECT_FALSE(contradicted_focal_length(with_focal_length(pinhole, 1.3), views(pinhole, 0))) << "from above";
    EXPECT_FALSE(contradicted_focal_length(camera, {})) << "nothing";
    std::vector<Sighting> few = views(camera, 0.7);
    few.resize(2);
    EXPECT_FALSE(contradicted_focal_length(with_focal_length(camera, 1.3), few)) << "too few";
    std::vector<Sighting> bent = views(camera, 0.7); // no focal length explains points of another board
    for (Sighting& s : bent)
        for (std::size_t i = 0; i < s.points.size(); ++i)
            s.points[i].pixel += glm::dvec2(9 * std::sin(7.0 * double(i)), 5 * std::cos(11.0 * double(i)));
    EXPECT_FALSE(contradicted_focal_length(camera, bent)) << "another board";
}

} // namespace
} // namespace ar::test
