// An avatar in the room with the mirror: seen there, never before its user's eyes,
// the same bits from the same orders.

#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/projection.h"
#include "tests/support/data.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/devices/tracking/key_hands.h"
#include "viewer/devices/tracking/own_avatar.h"
#include "viewer/engine/render_session.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

constexpr int kWidth = 80, kHeight = 60;
constexpr double kEyes_m = 1.6;

/// A session in the mirror room; with an avatar where one is given.
struct Room {
    gi::Report report;
    std::shared_ptr<OwnAvatar const> avatar;
    std::unique_ptr<RenderSession> session;

    explicit Room(std::optional<gi::Scene> const& model)
    {
        if (model) avatar = std::make_shared<OwnAvatar const>(*model, kEyes_m);
        session = std::make_unique<RenderSession>(
            [own = avatar](std::string const&, gi::Report&) {
                gi::Scene room = gi::generate_mirror();
                return std::make_shared<gi::Scene const>(own ? own->joined(std::move(room)) : std::move(room));
            },
            0, report);
        if (avatar)
            session->drive_bodies(
                [own = avatar](gi::Scene const& s, FrameCommand const& o, gi::Pose& p) { own->drive(s, o, p); });
        session->apply({"denoise", "none"});
        session->apply({"reuse", 1});
        session->apply({"scene", "mirror"});
    }
    SessionFrame render(FrameCommand const& command) { return session->render(command, {}); }
};

/// Standing there, looking into the mirror. @param raised_s  how long the right hand has been rising
FrameCommand standing(std::uint64_t frame, double raised_s, double aside_m = 0, double pitch_rad = 0)
{
    FrameCommand o;
    o.frame = frame;
    KeyHands hands;
    hands.step(false, true, raised_s);
    gi::dquat const nod = glm::angleAxis(pitch_rad, gi::dvec3{1, 0, 0});
    o.tracked = hands.with_head({{aside_m, kEyes_m, 0}, nod});
    gi::Camera camera = gi::generate_mirror().cameras.at(0);
    camera.world_from_camera = glm::translate(gi::dmat4(1), o.tracked.head->position) * glm::mat4_cast(nod);
    camera.yfov_rad = 1.1;
    o.views.push_back({"eye", camera, kWidth, kHeight, -1});
    o.paths = 64;
    return o;
}

std::vector<float> const& color(SessionFrame const& f) { return f.views[0].picture.find("color")->data; }

/// The share of tiles of 2 x 2 pixels whose mean blue, cut off at white, differs by more than 0.05: of both
/// halves of the mirror, and of what is outside.
struct Share {
    double left, right, outside;
};

Share differing(std::vector<float> const& a, std::vector<float> const& b)
{
    constexpr int kTile = 2;
    gi::CameraRays const rays = gi::camera_rays(standing(0, 0).views[0].camera, kWidth, kHeight, gi::dvec3{0});
    gi::vec2 const low = gi::Projection(rays)({-0.86f, 2.16f, -1.58f}),
                   high = gi::Projection(rays)({0.86f, 0.14f, -1.58f});
    int count[3] = {}, other[3] = {};
    for (int y0 = 0; y0 < kHeight; y0 += kTile)
        for (int x0 = 0; x0 < kWidth; x0 += kTile) {
            float sum = 0;
            for (int y = y0; y < y0 + kTile; ++y)
                for (int x = x0; x < x0 + kTile; ++x) {
                    std::size_t const blue = 3 * std::size_t(y * kWidth + x) + 2;
                    sum += std::min(1.0f, a[blue]) - std::min(1.0f, b[blue]);
                }
            bool const mirror =
                float(x0 + kTile) > low.x && float(x0)<high.x&& float(y0 + kTile)> low.y && float(y0) < high.y;
            int const part = !mirror ? 2 : 2 * x0 < kWidth ? 0 : 1;
            ++count[part];
            if (std::abs(sum) > 0.05f * kTile * kTile) ++other[part];
        }
    return {double(other[0]) / count[0], double(other[1]) / count[1], double(other[2]) / count[2]};
}

/// The first frame of a session of its own: with equal random numbers, noise does not hide what differs.
SessionFrame first_frame(std::optional<gi::Scene> const& model, double raised_s)
{
    Room room(model);
    room.session->apply({"method", "reference"});
    return room.render(standing(0, raised_s));
}

void expect_seen_in_the_mirror(gi::Scene const& model)
{
    SessionFrame const empty = first_frame({}, 0), down = first_frame(model, 0), raised = first_frame(model, 1);
    Share const body = differing(color(down), color(empty)), hand = differing(color(down), color(raised));
    EXPECT_GT(std::min(body.left, body.right), 0.04) << "the avatar is in the mirror";
    EXPECT_LT(body.outside, 0.1 * body.left) << "and hardly anywhere else";
    EXPECT_GT(hand.right, 0.005) << "the right hand rises there";
    EXPECT_LT(hand.left, 0.3 * hand.right) << "the left one does not";
}

TEST(AvatarInMirror, TheGeneratedOneIsSeen) { expect_seen_in_the_mirror(gi::generate_avatar()); }

TEST(AvatarInMirror, QuaterniusHumanIsSeen)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    gi::Report report;
    expect_seen_in_the_mirror(
        gi::load_scene((gi::test::shared_data() / "avatars/quaternius_human.glb").string(), report));
}

/// What one sees first is never one's own head: it is farther away than any of it could be.
TEST(AvatarInMirror, ItsHeadIsNotInItsUsersWay)
{
    Room room(gi::generate_avatar());
    std::uint64_t frame = 0;
    for (double const pitch : {-0.9, -0.4, 0.0, 0.7}) {
        FrameCommand command = standing(frame++, 0, 0, pitch);
        command.paths = 1;
        command.views[0].camera.yfov_rad = 1.4; // as wide as headsets
        SessionFrame const f = room.render(command);
        gi::Layer const* const depth = f.views[0].picture.find("depth");
        ASSERT_NE(depth, nullptr);
        float nearest = 1e9f;
        for (float const d : depth->data)
            if (d > 0) nearest = std::min(nearest, d);
        EXPECT_GT(nearest, 0.12f) << "pitch " << pitch;
    }
}

/// The first user walks: the feet that footsteps add are in the orders, and who has these needs no memory.
TEST(AvatarInMirror, StepsAreInTheOrders)
{
    OwnAvatar const model(gi::generate_avatar(), kEyes_m);
    ASSERT_TRUE(model.stance());
    Footsteps feet(*model.stance());
    std::vector<std::vector<std::uint8_t>> commands;
    std::vector<std::vector<float>> runs[2];
    Room live(gi::generate_avatar());
    double highest_m = 0;
    for (std::uint64_t f = 0; f < 8; ++f) {
        FrameCommand command = standing(f, 0, 0.06 * double(f));
        command.paths = 1;
        feet.step(command.tracked, command.world_from_room, 0.05);
        for (auto const& foot : {command.tracked.left_foot, command.tracked.right_foot})
            highest_m = std::max(highest_m, foot->position.y);
        runs[0].push_back(color(live.render(command)));
        commands.push_back(to_bytes(command));
    }
    EXPECT_GT(highest_m, 0.02) << "in the middle of a step";
    Room replayed(gi::generate_avatar());
    for (auto const& bytes : commands) runs[1].push_back(color(replayed.render(command_from_bytes(bytes))));
    EXPECT_EQ(runs[0], runs[1]);
}

/// As recorded, sent and replayed: through the bytes of the orders.
TEST(AvatarInMirror, TheSameOrdersGiveTheSamePixels)
{
    std::vector<std::vector<float>> runs[2];
    for (auto& run : runs) {
        Room room(gi::generate_avatar());
        for (std::uint64_t f = 0; f < 6; ++f) {
            FrameCommand command = standing(f, 0.15 * double(f), 0.02 * double(f));
            command.paths = 1;
            if (f == 4) command.tracked.left_hand.reset();
            run.push_back(color(room.render(&run == runs ? command : command_from_bytes(to_bytes(command)))));
        }
    }
    EXPECT_EQ(runs[0], runs[1]);
    EXPECT_NE(runs[0][0], runs[0][5]);
}

} // namespace
} // namespace viewer::test
