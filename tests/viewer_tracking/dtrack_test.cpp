// ART DTrack's ASCII packets.

#include "gi/core/pose.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/dtrack.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

// A flystick whose angles and matrix the manual gives side by side.
constexpr char kFlystick[] =
    "6df 1 [0 1.000 2][261.103 116.520 41.085 19.6522 -57.3530 116.5992]"
    "[-0.241543 0.968868 -0.054332 -0.482366 -0.168461 -0.859619 -0.842010 -0.181427 0.508039]\r\n";

TEST(DTrack, ReadsTheManualsExample)
{
    TrackerPacket const p = parse_dtrack(std::string("fr 21753\r\nts 39596.024831\r\n6dcal 3\r\n") + kFlystick);
    EXPECT_EQ(p.malformed, 0u);
    EXPECT_EQ(p.frame, 21753u);
    ASSERT_EQ(p.samples.size(), 1u);
    TrackerSample const& s = p.samples[0];
    EXPECT_EQ(s.body, "flystick0");
    EXPECT_EQ(s.buttons, 2u);
    EXPECT_DOUBLE_EQ(*s.measured_s, 39596.024831);
    EXPECT_LT(glm::distance(s.pose.position, {0.261103, 0.116520, 0.041085}), 1e-12);
    // R = Rx(eta) Ry(theta) Rz(phi): the angles say the same as the matrix read column by column.
    gi::dquat const angles = gi::exp_rotation({glm::radians(19.6522), 0, 0}) *
                             gi::exp_rotation({0, glm::radians(-57.3530), 0}) *
                             gi::exp_rotation({0, 0, glm::radians(116.5992)});
    EXPECT_LT(glm::degrees(angle_between(angles, s.pose.rotation)), 1e-3);
}

TEST(DTrack, ReadsBodiesAndFlysticks)
{
    std::string const unit = "[1 0 0 0 1 0 0 0 1]";
    TrackerPacket const p =
        parse_dtrack("fr 7\n6d 2 [0 1.0][1000 2000 -500 0 0 0]" + unit + " [3 0.5][1 2 3 0 0 0]" + unit +
                     "\n6df2 3 2 [0 1.000 6 2][10 20 30]" + unit +
                     "[5 0.25 -1.00] [1 -1.000 4 0][0 0 0]"
                     "[0 0 0 0 0 0 0 0 0][9]\n3d 0\n");
    EXPECT_EQ(p.malformed, 0u);
    EXPECT_EQ(p.ignored, 1u);
    ASSERT_EQ(p.samples.size(), 4u);
    EXPECT_EQ(p.samples[0].body, "0");
    EXPECT_EQ(p.samples[0].pose.position, gi::dvec3(1, 2, -0.5));
    EXPECT_FALSE(p.samples[0].measured_s);
    EXPECT_EQ(p.samples[1].body, "3");
    EXPECT_EQ(p.samples[1].quality, 0.5);
    EXPECT_EQ(p.samples[2].buttons, 5u);
    EXPECT_TRUE(p.samples[2].visible);
    EXPECT_FALSE(p.samples[3].visible);
    EXPECT_EQ(p.samples[2].axes, (std::vector<double>{0.25, -1})) << "joystick";
    EXPECT_TRUE(p.samples[3].axes.empty());
    EXPECT_EQ(p.samples[3].buttons, 9u) << "buttons count where the flystick is not seen";
}

TEST(DTrack, CountsWhatIsMalformed)
{
    std::string const good = "[0 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]";
    for (std::string const& line :
         {std::string("fr x"), std::string("fr -1"), std::string("ts nan"), std::string("6d"), std::string("6d 1"),
          "6d 2 " + good, "6d 1 " + good + "x", std::string("6d 1 [0 1.0][1 2 3][1 0 0 0 1 0 0 0 1]"),
          std::string("6d 1 [0 1.0][1 2 3 0 0 0][2 0 0 0 1 0 0 0 1]"),
          std::string("6d 1 [0 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 -1]"),
          std::string("6d 1 [0 1.0][1 2 inf 0 0 0][1 0 0 0 1 0 0 0 1]"), std::string("6d 99999999 ") + good,
          std::string("6df2 1 1 [0 1 33 0][1 2 3][1 0 0 0 1 0 0 0 1][1]")})
        EXPECT_EQ(parse_dtrack(line).malformed, 1u) << line;
    EXPECT_EQ(parse_dtrack("6d 2 " + good).samples.size(), 1u) << "what came before is kept";
    EXPECT_EQ(parse_dtrack("").malformed, 0u);
}

TEST(DTrack, WritesWhatItReads)
{
    TrackerSample body, flystick;
    body.body = "4";
    body.pose = {{0.1, 1.7, -2.25}, gi::exp_rotation({0.3, -0.7, 1.1})};
    body.measured_s = 12.5;
    flystick.body = "flystick1";
    flystick.pose = {{-1, 0.5, 3}, gi::exp_rotation({-2, 0.1, 0})};
    flystick.buttons = 0x80000001u;
    flystick.axes = {-0.5, 1};
    flystick.measured_s = 12.5;
    TrackerPacket const p = parse_dtrack(format_dtrack({body, flystick}, 99));
    EXPECT_EQ(p.malformed, 0u);
    EXPECT_EQ(p.frame, 99u);
    ASSERT_EQ(p.samples.size(), 2u);
    EXPECT_EQ(p.samples[0].body, "4");
    EXPECT_LT(glm::distance(p.samples[0].pose.position, body.pose.position), 1e-7);
    EXPECT_LT(angle_between(p.samples[0].pose.rotation, body.pose.rotation), 1e-7);
    EXPECT_EQ(p.samples[0].measured_s, 12.5);
    EXPECT_LT(angle_between(p.samples[1].pose.rotation, flystick.pose.rotation), 1e-7);
    EXPECT_EQ(p.samples[1].axes, flystick.axes);
    EXPECT_EQ(p.samples[1].buttons, 0x80000001u);
}

} // namespace
} // namespace viewer::test
