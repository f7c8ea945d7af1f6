#include "gi/core/rng.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

void expect_orthonormal(vec3 n)
{
    Frame const f = Frame::about(n);
    EXPECT_EQ(f.normal, n);
    EXPECT_NEAR(glm::length(f.tangent), 1, 1e-5);
    EXPECT_NEAR(glm::length(f.bitangent), 1, 1e-5);
    EXPECT_NEAR(glm::dot(f.tangent, f.bitangent), 0, 1e-5);
    EXPECT_NEAR(glm::dot(f.tangent, n), 0, 1e-5);
    EXPECT_NEAR(glm::distance(glm::cross(f.tangent, f.bitangent), n), 0, 1e-5) << "right-handed";
    vec3 const v{0.3f, -0.4f, 0.8f};
    EXPECT_NEAR(glm::distance(f.to_world(f.to_local(v)), v), 0, 1e-5);
    EXPECT_NEAR(glm::distance(f.to_local(n), vec3{0, 0, 1}), 0, 1e-5);
}

TEST(Frame, IsOrthonormalForAllNormals)
{
    Pcg32 rng(1, 1);
    for (int i = 0; i < 10000; ++i)
        expect_orthonormal(glm::normalize(vec3{rng.uniform(), rng.uniform(), rng.uniform()} - 0.5f));
}

TEST(Frame, IsOrthonormalAlongAndNearTheAxes)
{
    for (int axis = 0; axis < 3; ++axis)
        for (float const sign : {1.0f, -1.0f})
            for (float const lean : {0.0f, -0.0f, 1e-38f, 1e-8f, -1e-4f, 1e-3f}) {
                vec3 n{lean};
                n[axis] = sign;
                expect_orthonormal(glm::normalize(n));
            }
}

TEST(Luminance, WeighsToOne)
{
    EXPECT_FLOAT_EQ(luminance(vec3{1}), 1);
    EXPECT_GT(luminance({0, 1, 0}), luminance({1, 0, 0}));
    EXPECT_GT(luminance({1, 0, 0}), luminance({0, 0, 1}));
}

} // namespace
} // namespace gi::test
