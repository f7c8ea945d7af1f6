// Where users will be: exact at constant velocity, and never where nothing says that they will.

#include "viewer/engine/live/viewpoint.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

gi::dmat4 camera_at(gi::dvec3 at, double turn_rad)
{
    return glm::rotate(glm::translate(gi::dmat4(1), at), turn_rad, gi::dvec3{0, 1, 0});
}

/// Sees at 60 Hz what `of` says of a time. @return the last time
template <class Of>
double watch(Anticipation& a, Of const& of, int frames, double first_s = 0)
{
    double t = first_s;
    for (int k = 0; k < frames; ++k) {
        t = first_s + k / 60.0;
        Viewpoint v = of(t);
        v.pose_s = t;
        a.see(v);
    }
    return t;
}

Viewpoint walking(double t)
{
    Viewpoint v;
    v.tracked.head = RoomPose{{1.5 * t, 1.7, -0.5 * t}, glm::angleAxis(0.8 * t, gi::dvec3{0, 1, 0})};
    v.tracked.left_hand = RoomPose{{0.3, 1, 0}, {1, 0, 0, 0}};
    v.others.resize(1);
    v.others[0].head = RoomPose{{0, 1.6 + 0.1 * t, 0}, {1, 0, 0, 0}};
    v.world_from_room = glm::translate(gi::dmat4(1), gi::dvec3{0, 0, 2 * t});
    ViewCommand view{"window", {}, 40, 30, -1};
    view.camera.world_from_camera = camera_at({1.5 * t, 1.7, 1.5 * t}, 0.8 * t);
    v.views = {view};
    return v;
}

void expect_same(gi::dmat4 const& a, gi::dmat4 const& b, double most)
{
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(a[c][r], b[c][r], most) << c << ", " << r;
}

TEST(Anticipation, ConstantVelocityIsExact)
{
    Anticipation a;
    double const t = watch(a, walking, 10);
    for (double const ahead_s : {0.0, 0.01, 0.05, Anticipation::kFarthest_s}) {
        Viewpoint const v = a.at(t, t + ahead_s), truth = walking(t + ahead_s);
        EXPECT_EQ(v.pose_s, t); // of what was measured
        expect_same(v.views[0].camera.world_from_camera, truth.views[0].camera.world_from_camera, 1e-9);
        expect_same(v.world_from_room, truth.world_from_room, 1e-9);
        EXPECT_LT(glm::length(v.tracked.head->position - truth.tracked.head->position), 1e-9);
        EXPECT_NEAR(std::abs(glm::dot(v.tracked.head->rotation, truth.tracked.head->rotation)), 1, 1e-12);
        EXPECT_EQ(v.tracked.left_hand, truth.tracked.left_hand);
        EXPECT_NEAR(v.others[0].head->position.y, truth.others[0].head->position.y, 1e-9);
        EXPECT_FALSE(v.tracked.right_hand.has_value());
    }
    // Never further than kFarthest_s, and never back.
    Viewpoint const far = a.at(t, t + 10), most = walking(t + Anticipation::kFarthest_s);
    expect_same(far.views[0].camera.world_from_camera, most.views[0].camera.world_from_camera, 1e-9);
    expect_same(a.at(t, t - 1).views[0].camera.world_from_camera, walking(t).views[0].camera.world_from_camera, 0);
}

/// Light: on the way, but not behind walls, nor where less than half of what is seen now is in the picture.
TEST(Anticipation, LooksFarAheadAsFarAsTheWayIsFree)
{
    Anticipation a;
    double const t = watch(a, walking, 10); // 2.1 m/s, 0.8 rad/s
    auto const ahead = [&](double later_s, double free_m) {
        return a
            .far_ahead(t, later_s,
                       [&](gi::dvec3, gi::dvec3 direction, double most_m) {
                           EXPECT_NEAR(glm::length(direction), 1, 1e-9);
                           return std::min(free_m, most_m);
                       })[0]
            .camera.world_from_camera;
    };
    auto const truth = [&](double later_s) { return walking(t + later_s).views[0].camera.world_from_camera; };
    expect_same(ahead(0.4, 100), truth(0.4), 1e-9);
    double const half_fov_rad = std::atan(4.0 / 3 * std::tan(0.5 * walking(0).views[0].camera.yfov_rad));
    expect_same(ahead(5, 100), truth(std::min(Anticipation::kFarAhead_s, half_fov_rad / 0.8)), 1e-9);
    expect_same(ahead(0.4, 0.8), truth(0.5 / (1.5 * std::sqrt(2.0))), 1e-9); // 0.3 m are kept from the wall
    expect_same(ahead(0.4, 0.1), truth(Anticipation::kFarthest_s), 1e-9);
    expect_same(ahead(0.01, 0), truth(0.01), 1e-9);
    auto const all_free = [](auto, auto, double m) { return m; };
    EXPECT_TRUE(Anticipation().far_ahead(0, 1, all_free).empty());
    Anticipation wall; // whose edges move with the head
    double const until = watch(
        wall,
        [](double s) {
            Viewpoint v = walking(s);
            v.views[0].camera.off_axis = gi::ViewTangents{-1 - s, 1 - s, -1, 1};
            return v;
        },
        10);
    expect_same(wall.far_ahead(until, 0.4, all_free)[0].camera.world_from_camera,
                walking(until + Anticipation::kFarthest_s).views[0].camera.world_from_camera, 1e-9);
}

TEST(Anticipation, IsOfTheTimeThatPosesAreFor)
{
    Anticipation a;
    double const lead_s = 0.03; // a tracker that predicts by itself
    double const t = watch(
        a,
        [&](double s) {
            Viewpoint v = walking(s + lead_s);
            v.valid_s = s + lead_s;
            return v;
        },
        10);
    expect_same(a.at(t, t + 0.05).views[0].camera.world_from_camera,
                walking(t + 0.05).views[0].camera.world_from_camera, 1e-9);
    expect_same(a.at(t, t + 0.02).views[0].camera.world_from_camera, // it is further already
                walking(t + lead_s).views[0].camera.world_from_camera, 0);
}

TEST(Anticipation, WhoStandsStillStaysExactlyThere)
{
    Anticipation a;
    EXPECT_TRUE(a.at(0, 0.1).views.empty()) << "nothing seen yet";
    double t = watch(a, walking, 10);
    auto const stopped = [&, end = t](double) { return walking(end); };
    t = watch(a, stopped, 1, t + 1 / 60.0); // at once, not after the time over which velocities are measured
    Viewpoint const v = a.at(t, t + 0.1), truth = stopped(0);
    EXPECT_EQ(v.views, truth.views);
    EXPECT_EQ(v.tracked, truth.tracked);
    EXPECT_EQ(v.world_from_room, truth.world_from_room);
    t = watch(a, stopped, 30, t + 1 / 60.0);
    EXPECT_EQ(a.at(t, t + 0.1).views, truth.views);
}

TEST(Anticipation, AJumpLeadsNowhere)
{
    Anticipation a;
    double const t = watch(a, walking, 10);
    Viewpoint elsewhere = walking(t);
    elsewhere.pose_s = t + 1 / 60.0;
    elsewhere.views[0].camera.world_from_camera = camera_at({20, 3, -5}, 2);
    a.see(elsewhere);
    EXPECT_EQ(a.at(elsewhere.pose_s, elsewhere.pose_s + 0.1).views, elsewhere.views);
    // Moving on from there is predicted again.
    Viewpoint next = elsewhere;
    next.pose_s += 0.02;
    next.views[0].camera.world_from_camera = camera_at({20.02, 3, -5}, 2);
    a.see(next);
    expect_same(a.at(next.pose_s, next.pose_s + 0.02).views[0].camera.world_from_camera,
                camera_at({20.04, 3, -5}, 2), 1e-9);
}

TEST(Anticipation, OtherViewsOrPeopleBeginAnew)
{
    for (int const what : {0, 1, 2}) {
        Anticipation a;
        double const t = watch(a, walking, 10) + 1 / 60.0;
        Viewpoint v = walking(t);
        v.pose_s = t;
        if (what == 0) v.views[0].name = "wall";
        if (what == 1) v.others.clear();
        if (what == 2) v.views[0].camera.off_axis = gi::ViewTangents{-1, 1, -1, 1};
        a.see(v);
        EXPECT_EQ(a.at(t, t + 0.05).views, v.views) << what;
    }
}

TEST(Anticipation, IsForgottenAfterAWhile)
{
    Anticipation a;
    double const t = watch(a, walking, 10), late = t + Anticipation::kForgotten_s;
    EXPECT_NE(a.at(late - 0.001, late + 0.02).views, walking(t).views);
    EXPECT_EQ(a.at(late + 0.001, late + 0.02).views, walking(t).views);
    // Velocities over a gap say nothing.
    Viewpoint after = walking(t + 0.5);
    after.pose_s = t + 0.5;
    Anticipation gap;
    Viewpoint before = walking(t);
    before.pose_s = t;
    gap.see(before);
    gap.see(after);
    EXPECT_EQ(gap.at(t + 0.5, t + 0.52).views, after.views);
}

/// A head before a wall: the camera moves and the edges of its view move against it.
TEST(Anticipation, EdgesOfOffAxisViewsFollow)
{
    auto const at_wall = [](double t) {
        Viewpoint v = walking(0);
        double const x = 0.3 * t;
        v.views[0].camera.world_from_camera = camera_at({x, 1.7, 0}, 0);
        v.views[0].camera.off_axis = gi::ViewTangents{(-1.5 - x) / 2, (1.5 - x) / 2, -0.85, 0.6};
        return v;
    };
    Anticipation a;
    double const t = watch(a, at_wall, 10);
    gi::Camera const camera = a.at(t, t + 0.1).views[0].camera, truth = at_wall(t + 0.1).views[0].camera;
    expect_same(camera.world_from_camera, truth.world_from_camera, 1e-9);
    EXPECT_NEAR(camera.off_axis->left, truth.off_axis->left, 1e-9);
    EXPECT_NEAR(camera.off_axis->right, truth.off_axis->right, 1e-9);
    EXPECT_NEAR(camera.off_axis->bottom, -0.85, 1e-12);
    EXPECT_NEAR(camera.off_axis->top, 0.6, 1e-12);
}

/// A display's frame that is scaled or sheared is not extrapolated.
TEST(Anticipation, OnlyRigidFramesAreLedOn)
{
    auto const scaled = [](double t) {
        Viewpoint v = walking(t);
        v.world_from_room = glm::scale(v.world_from_room, gi::dvec3{2});
        return v;
    };
    Anticipation a;
    double const t = watch(a, scaled, 10);
    EXPECT_EQ(a.at(t, t + 0.05).world_from_room, scaled(t).world_from_room);
}

} // namespace
} // namespace viewer::test
