#include "viewer/protocol/frame_command.h"

#include "gi/core/error.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace viewer::test {
namespace {

double constexpr kNaN = std::numeric_limits<double>::quiet_NaN();

/// What a viewer in a window sends: one turned camera, one change.
FrameCommand desktop_order()
{
    FrameCommand o;
    o.frame = 123456;
    o.pose_s = 2057.6012345;
    o.display_s = 2057.617912;
    o.scene_s = 12.345678;
    ViewCommand v;
    v.name = "window";
    v.camera = gi::look_at({1.25, 1.7, 3.1}, {0.3, 1.2, -0.4}, 60);
    v.width = 1920;
    v.height = 1080;
    o.views = {v};
    o.paths = 4;
    return o;
}

FrameCommand cave_order()
{
    FrameCommand o = desktop_order();
    o.world_from_room[3] = {0.1, -0.0, 1e-300, 1};
    o.tracked.head = {{0.1, 1.8, 0.2}, glm::normalize(gi::dquat(0.9, 0.1, -0.2, 0.05))};
    o.tracked.right_hand = {{0.4, 1.1, -0.2}, glm::normalize(gi::dquat(0.3, 0.1, 0.2, 0.5))};
    o.tracked.left_foot = {{0.1, 0, 0.3}, {1, 0, 0, 0}};
    o.others = {{}, o.tracked, {}};
    o.others[1].head.reset();
    o.changes = {{"exposure", 1.5},
                 {"method", "paths"},
                 {"object.door.position", {0.1, 2, -3e-9}},
                 {"light.0", {{"on", true}, {"color", {1, 0.1 + 0.2, 0}}, {"note", nullptr}}}};
    o.views.clear();
    for (int i = 0; i < 8; ++i) {
        ViewCommand v = desktop_order().views[0];
        v.name = "wall " + std::to_string(i / 2) + (i % 2 == 0 ? ", left eye" : ", right eye");
        v.camera.off_axis = gi::ViewTangents{-0.31 - i, 1.0 / 3, -0.7, 0.9};
        v.partner = i % 2 == 0 ? -1 : i - 1;
        o.views.push_back(v);
    }
    o.views[1].camera.aperture_radius_m = 0.01;
    o.views[1].camera.focus_distance_m = 2.5;
    o.views[2].camera.off_axis.reset();
    o.views[2].camera.orthographic = true;
    o.views[2].camera.ymag_m = 3.25;
    return o;
}

std::string why_refused(FrameCommand const& command)
{
    try {
        to_bytes(command);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

TEST(FrameCommand, ComesBackInAllItsBits)
{
    for (FrameCommand const& o : {FrameCommand{}, desktop_order(), cave_order()}) {
        FrameCommand const back = command_from_bytes(to_bytes(o));
        EXPECT_EQ(back, o);
        EXPECT_EQ(to_bytes(back), to_bytes(o)); // also distinguishes -0 from 0
    }
    EXPECT_TRUE(std::signbit(command_from_bytes(to_bytes(cave_order())).world_from_room[3].y));
}

/// Of before there were feet and further users.
TEST(FrameCommand, OldOnesAreRead)
{
    FrameCommand o;
    o.tracked.head = {{1, 2, 3}, {1, 0, 0, 0}};
    o.tracked.right_hand = {{4, 5, 6}, {1, 0, 0, 0}};
    std::vector<std::uint8_t> const old{1,  0, 0, 0, 0,  0, 0, 0,  0,  0, 0, 0, 0,  0, 0, 0,  0,   0,  0, 0, 0,
                                        0,  0, 0, 0, 0,  1, 0, 0,  5,  7, 0, 0, 0,  0, 0, 0,  240, 63, 0, 0, 0,
                                        0,  0, 0, 0, 64, 0, 0, 0,  0,  0, 0, 8, 64, 7, 0, 0,  0,   0,  0, 0, 16,
                                        64, 0, 0, 0, 0,  0, 0, 20, 64, 0, 0, 0, 0,  0, 0, 24, 64,  0,  0};
    EXPECT_EQ(command_from_bytes(old), o);
    EXPECT_EQ(to_bytes(o), old);
}

/// The second version has a light scale; where that is 1, bytes are those of the first.
TEST(FrameCommand, LightMayBeSmaller)
{
    FrameCommand o = cave_order();
    std::vector<std::uint8_t> const full = to_bytes(o);
    EXPECT_EQ(full[0], 1);
    o.light_scale = 0.375;
    std::vector<std::uint8_t> const small = to_bytes(o);
    EXPECT_EQ(small[0], 2);
    EXPECT_EQ(small.size(), full.size() + 8);
    EXPECT_EQ(command_from_bytes(small), o);
    EXPECT_EQ(to_bytes(command_from_bytes(small)), small);
    for (double const wrong : {0.0, -0.25, 1.001, 1e300, kNaN, std::numeric_limits<double>::infinity()}) {
        o.light_scale = wrong;
        std::string const why = why_refused(o);
        EXPECT_NE(why.find("of the size of the views"), std::string::npos) << wrong << why;
    }
    std::vector<std::uint8_t> unknown = full;
    for (std::uint8_t const version : {std::uint8_t(0), std::uint8_t(6), std::uint8_t(255)}) {
        unknown[0] = version;
        EXPECT_THROW(command_from_bytes(unknown), gi::InputError) << int(version);
    }
}

/// The third version has a surface scale, too.
TEST(FrameCommand, SurfacesMayBeSmaller)
{
    FrameCommand o = cave_order();
    std::size_t const bytes = to_bytes(o).size();
    o.light_scale = 0.375;
    o.surface_scale = 0.5;
    std::vector<std::uint8_t> const small = to_bytes(o);
    EXPECT_EQ(small[0], 3);
    EXPECT_EQ(small.size(), bytes + 16);
    EXPECT_EQ(command_from_bytes(small), o);
    for (double const wrong : {0.25, 1.001, kNaN}) {
        o.surface_scale = wrong;
        EXPECT_NE(why_refused(o).find("surfaces at"), std::string::npos) << wrong;
    }
}

/// The fourth version has margins, too.
TEST(FrameCommand, PicturesMayHaveMargins)
{
    FrameCommand o = cave_order();
    o.light_scale = 0.375;
    std::size_t const bytes = to_bytes(o).size();
    o.views[0].margin_x = 12;
    o.views[0].margin_y = 200;
    std::vector<std::uint8_t> const wide = to_bytes(o);
    EXPECT_EQ(wide[0], 4);
    EXPECT_EQ(wide.size(), bytes + 8 + 2 * o.views.size() + 1);
    EXPECT_EQ(command_from_bytes(wide), o);
    for (int const wrong : {-1, o.views[0].width + 1}) {
        o.views[0].margin_x = wrong;
        EXPECT_NE(why_refused(o).find("a margin of"), std::string::npos) << wrong;
    }
    o.views[0].margin_x = 12;
    o.light_scale = 1;
    EXPECT_NE(why_refused(o).find("whose light has its size"), std::string::npos);
}

/// The fifth version may leave surfaces to others.
TEST(FrameCommand, OthersMayDrawSurfaces)
{
    FrameCommand o = cave_order();
    o.light_scale = 0.375;
    std::size_t const bytes = to_bytes(o).size();
    o.only_light = true;
    std::vector<std::uint8_t> alone = to_bytes(o);
    EXPECT_EQ(alone[0], 5);
    EXPECT_EQ(alone.size(), bytes + 8 + 2 * o.views.size());
    EXPECT_EQ(command_from_bytes(alone), o);
    o.light_scale = 1;
    EXPECT_NE(why_refused(o).find("light alone"), std::string::npos);
}

TEST(FrameCommand, RandomNumbersComeBackExactly)
{
    std::mt19937_64 random(7);
    auto const number = [&] { return std::ldexp(double(std::int64_t(random())), int(random() % 120) - 123); };
    for (int n = 0; n < 2000; ++n) {
        FrameCommand o = desktop_order();
        o.frame = random();
        for (double* const v : {&o.pose_s, &o.display_s, &o.scene_s}) *v = number();
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r) o.views[0].camera.world_from_camera[c][r] = number();
        o.changes = {{"k", number()}, {"i", std::int64_t(random())}, {"u", random()}};
        FrameCommand const back = command_from_bytes(to_bytes(o));
        ASSERT_EQ(back, o) << n;
        for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(back.changes[i].value.is_number_float(), i == 0);
    }
}

TEST(FrameCommand, IsSmall)
{
    EXPECT_LE(to_bytes(desktop_order()).size(), 160u);
    std::size_t const eight = to_bytes(cave_order()).size();
    EXPECT_LE(eight, 160u + 8 * 160u + 300u);
}

TEST(FrameCommand, EveryCutAndEveryFlippedByteIsAnOrderOrAnInputError)
{
    std::vector<std::uint8_t> const whole = to_bytes(cave_order());
    for (std::size_t n = 0; n < whole.size(); ++n) {
        EXPECT_THROW(command_from_bytes(std::span(whole).first(n)), gi::InputError) << n;
        for (int bit = 0; bit < 8; ++bit) {
            auto damaged = whole;
            damaged[n] ^= std::uint8_t(1 << bit);
            try {
                check_command(command_from_bytes(damaged));
            } catch (gi::InputError const&) {
            }
        }
    }
    auto longer = whole;
    longer.push_back(0);
    EXPECT_THROW(command_from_bytes(longer), gi::InputError);
    longer = whole;
    longer[0] = 6;
    try {
        command_from_bytes(longer);
        FAIL();
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("version 6"), std::string::npos) << e.what();
    }
}

TEST(FrameCommand, ClaimedCountsTakeNoMemory)
{
    std::vector<std::uint8_t> bytes = to_bytes(FrameCommand{});
    bytes.back() = 0xff; // the number of views
    bytes.insert(bytes.end(), {0xff, 0xff, 0xff, 0x7f});
    EXPECT_THROW(command_from_bytes(bytes), gi::InputError);
    EXPECT_THROW(command_from_bytes(std::vector<std::uint8_t>(11, 0xff)), gi::InputError);
}

TEST(FrameCommand, WhatCannotBeRenderedIsRefused)
{
    using Spoil = void (*)(FrameCommand&);
    std::pair<Spoil, char const*> const cases[] = {
        {[](FrameCommand& o) { o.pose_s = kNaN; }, "time"},
        {[](FrameCommand& o) { o.paths = 0; }, "paths"},
        {[](FrameCommand& o) { o.paths = -4; }, "paths"},
        {[](FrameCommand& o) { o.world_from_room[0][3] = 0.5; }, "affine"},
        {[](FrameCommand& o) { o.world_from_room[0] = o.world_from_room[1]; }, "flattens"},
        {[](FrameCommand& o) { o.tracked.head->rotation.w = 3; }, "unit"},
        {[](FrameCommand& o) { o.tracked.head->position.x = kNaN; }, "head"},
        {[](FrameCommand& o) {
             o.others = {{}};
             o.others[0].right_foot = {{0, kNaN, 0}, {1, 0, 0, 0}};
         },
         "right_foot"},
        {[](FrameCommand& o) { o.others.resize(CommandLimits::users + 1); }, "users"},
        {[](FrameCommand& o) { o.views[0].width = 0; }, "pixels"},
        {[](FrameCommand& o) { o.views[0].height = 16385; }, "pixels"},
        {[](FrameCommand& o) { o.views[0].partner = 0; }, "partner"},
        {[](FrameCommand& o) { o.views[3].partner = -2; }, "partner"},
        {[](FrameCommand& o) { o.views[0].camera.off_axis->left = 1; }, "inside"},
        {[](FrameCommand& o) { o.views[2].camera.ymag_m = 0; }, "height"},
        {[](FrameCommand& o) { o.views[0].camera.off_axis.reset(), o.views[0].camera.yfov_rad = 3.2; }, "field"},
        {[](FrameCommand& o) { o.views[0].camera.aperture_radius_m = -1; }, "aperture"},
        {[](FrameCommand& o) { o.views[0].name.resize(5000); }, "name"},
        {[](FrameCommand& o) { o.views.resize(257, o.views[0]); }, "views"},
        {[](FrameCommand& o) { o.changes[0].value = kNaN; }, "exposure"},
        {[](FrameCommand& o) { o.changes[0].value = "\xff"; }, "exposure"},
        {[](FrameCommand& o) { o.changes[0].value = std::string(1 << 20, 'a'); }, "exposure"},
        {[](FrameCommand& o) { o.changes[0].key.clear(); }, "key"},
    };
    for (auto const& [spoil, word] : cases) {
        FrameCommand o = cave_order();
        ASSERT_EQ(why_refused(o), "");
        spoil(o);
        EXPECT_NE(why_refused(o).find(word), std::string::npos) << word << ": " << why_refused(o);
    }
}

TEST(FrameCommand, DeepValuesAreRefusedBeforeTheyFillTheStack)
{
    nlohmann::json deep = 1;
    for (int i = 0; i < CommandLimits::value_depth; ++i) deep = nlohmann::json::array({deep});
    FrameCommand o = desktop_order();
    o.changes = {{"k", deep}};
    EXPECT_EQ(command_from_bytes(to_bytes(o)), o);
    o.changes = {{"k", nlohmann::json::array({deep})}};
    EXPECT_NE(why_refused(o).find("deep"), std::string::npos);
}

} // namespace
} // namespace viewer::test
