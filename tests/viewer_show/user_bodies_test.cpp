// What orders have of users with avatars: their trackers' bodies, and what stands in for what is not tracked.

#include "viewer/app/user_body.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

Display three_users()
{
    Display d;
    for (double const x : {-1.0, 0.0, 1.0}) {
        User user;
        user.head.translation_m = {x, 1.7, 0};
        d.users.push_back(user);
    }
    return d;
}

TEST(UserBodies, OrdersHaveThoseOfUsersWithAvatars)
{
    Display const display = three_users();
    UserBodies bodies({{0, std::nullopt}, {2, Stance{}}});
    std::vector<std::size_t> asked;
    auto const tracked = [&](std::size_t user) {
        asked.push_back(user);
        Tracked t;
        if (user == 0) t.head = RoomPose{{0.2, 1.6, 0.1}, {1, 0, 0, 0}};
        if (user == 0) t.left_foot = RoomPose{{0.1, 0, 0.1}, {1, 0, 0, 0}};
        if (user == 2) t.right_hand = RoomPose{{1.3, 1, -0.3}, {1, 0, 0, 0}};
        return t;
    };
    Viewpoint at;
    bodies.put(display, tracked, 0.01, at);
    EXPECT_EQ(asked, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(at.tracked, tracked(0)) << "an avatar without legs does not step, but trackers' feet are kept";
    ASSERT_EQ(at.others.size(), 2u);
    EXPECT_EQ(at.others[0], Tracked{}) << "nobody asks where somebody without an avatar is";
    Tracked const& third = at.others[1];
    ASSERT_TRUE(third.head && third.left_foot && third.right_foot);
    EXPECT_EQ(third.head->position, (gi::dvec3{1, 1.7, 0})) << "where it rests";
    EXPECT_EQ(third.right_hand, tracked(2).right_hand);
    EXPECT_EQ(third.left_foot->position.y, 0);
    EXPECT_LT(third.left_foot->position.x, third.right_foot->position.x);
}

TEST(UserBodies, TheFirstUserMayHaveNone)
{
    UserBodies bodies({{1, Stance{}}});
    EXPECT_EQ(bodies.first(), nullptr);
    Viewpoint at;
    at.tracked.head = RoomPose{{0, 1.7, 0}, {1, 0, 0, 0}};
    Tracked const before = at.tracked;
    bodies.put(
        three_users(), [](std::size_t) { return Tracked{}; }, 0.01, at);
    EXPECT_EQ(at.tracked, before);
    EXPECT_EQ(at.others.size(), 1u);
}

} // namespace
} // namespace viewer::test
