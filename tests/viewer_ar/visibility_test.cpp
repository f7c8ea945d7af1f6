#include "ar/pipeline/visibility.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

std::vector<glm::dvec3> box(glm::dvec3 middle, double half)
{
    std::vector<glm::dvec3> corners;
    for (int k = 0; k < 8; ++k)
        corners.push_back(middle +
                          half * glm::dvec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1));
    return corners;
}

TEST(Visibility, SaysWhyNothingIsSeen)
{
    CameraModel const camera{LensModel::pinhole, {640, 480}, 500, 500, 319.5, 239.5, {}};
    gi::RigidPose const origin; // looks along z
    struct Case {
        std::vector<glm::dvec3> corners;
        Visibility why;
    };
    for (Case const& c :
         {Case{box({0, 0, -2}, 0.1), Visibility::behind}, Case{box({5, 0, 2}, 0.1), Visibility::outside},
          Case{box({0, -9, 2}, 0.1), Visibility::outside}, Case{box({0, 0, 800}, 0.1), Visibility::small},
          Case{box({0, 0, 2}, 0.1), Visibility::hidden}, Case{{}, Visibility::unknown}})
        EXPECT_EQ(visibility_of(camera, origin, c.corners, false), c.why) << name_of(c.why);
    EXPECT_EQ(visibility_of(camera, origin, box({0, 0, 2}, 0.1), true), Visibility::seen);
    EXPECT_EQ(visibility_of(camera, origin, box({0, 0, 0.05}, 0.1), true), Visibility::seen)
        << "around the camera";
    EXPECT_EQ(visibility_of(camera, origin, box({0, 0, 100}, 0.1), true), Visibility::small) << "one pixel";
    EXPECT_EQ(visibility_of(camera, origin, {}, true), Visibility::unknown);
}

} // namespace
} // namespace ar::test
