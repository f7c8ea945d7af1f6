#include "viewer/app/surfaces_scale.h"

#include <gtest/gtest.h>

namespace viewer::test::surfaces_scale {
namespace {

/// Draws pictures that take so long at full size; returns the last scale.
double after(SurfacesScale& s, int pictures, double full_s)
{
    for (int k = 0; k < pictures; ++k) s.measured(s.next(), full_s * s.next() * s.next());
    return s.next();
}

TEST(SurfacesScale, IsTheLargestThatIsFastEnough)
{
    SurfacesScale s;
    EXPECT_EQ(s.next(), 0.5);
    EXPECT_EQ(after(s, 200, 0.01), 1);
    EXPECT_EQ(after(s, 200, 0.07), 0.75);
    EXPECT_EQ(after(s, 200, 0.15), 0.5);
    EXPECT_EQ(after(s, 200, 1), 0.4); // there is nothing smaller
}

TEST(SurfacesScale, DoesNotChangeToAndFro)
{
    SurfacesScale s;
    int changes = 0;
    for (int k = 0; k < 500; ++k) {
        double const before = s.next();
        s.measured(before, before > 0.6 ? 0.06 : 0.015); // larger takes longer than its pixels tell
        changes += s.next() != before;
    }
    EXPECT_LT(changes, 16);
}

} // namespace
} // namespace viewer::test::surfaces_scale
