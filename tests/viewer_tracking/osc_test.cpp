// Poses in OSC packets.

#include "gi/core/error.h"
#include "gi/core/pose.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/osc.h"

#include <gtest/gtest.h>
#include <limits>
#include <lo/lo.h>

namespace viewer::test {
namespace {

using Bytes = std::vector<unsigned char>;

/// A message of floats, as liblo writes it.
Bytes message(std::string const& path, std::vector<float> const& values)
{
    lo_message const m = lo_message_new();
    for (float const v : values) lo_message_add_float(m, v);
    std::size_t size = lo_message_length(m, path.c_str());
    Bytes bytes(size);
    lo_message_serialise(m, path.c_str(), bytes.data(), &size);
    lo_message_free(m);
    return bytes;
}

Bytes bundle(std::uint32_t seconds, std::uint32_t fraction, std::vector<Bytes> const& parts)
{
    Bytes b{'#', 'b', 'u', 'n', 'd', 'l', 'e', 0};
    auto const add = [&](std::uint32_t v) {
        for (int shift = 24; shift >= 0; shift -= 8) b.push_back((unsigned char)(v >> shift));
    };
    add(seconds);
    add(fraction);
    for (Bytes const& p : parts) {
        add(std::uint32_t(p.size()));
        b.insert(b.end(), p.begin(), p.end());
    }
    return b;
}

TEST(Osc, ReadsAPose)
{
    TrackerPacket const p = parse_osc(message("/tracker/head/pose", {1, 2, 3, 0, 0.6f, 0, 0.8f}));
    EXPECT_EQ(p.malformed + p.ignored, 0u);
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].body, "head");
    EXPECT_EQ(p.samples[0].parts, SampleParts::pose);
    EXPECT_EQ(p.samples[0].pose.position, gi::dvec3(1, 2, 3));
    EXPECT_NEAR(p.samples[0].pose.rotation.y, 0.6, 1e-7);
    EXPECT_NEAR(p.samples[0].pose.rotation.w, 0.8, 1e-7);
    EXPECT_FALSE(p.samples[0].measured_s);
}

TEST(Osc, EulerAnglesAreYawThenPitchThenRoll)
{
    TrackerPacket const p = parse_osc(message("/tracker/1/euler", {90, 30, 0}));
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].parts, SampleParts::rotation);
    // To the left, then up: forward (-z) turns to -x and rises.
    gi::dvec3 const forward = p.samples[0].pose.rotation * gi::dvec3(0, 0, -1);
    EXPECT_LT(glm::distance(forward, {-std::sqrt(0.75), 0.5, 0}), 1e-6);
}

TEST(Osc, PartsOfABundleAreOneSampleWithItsTime)
{
    TrackerPacket const p = parse_osc(bundle(100, 0x80000000u,
                                             {message("/tracking/trackers/2/position", {1, 2, 3}),
                                              message("/tracking/trackers/2/rotation", {0, 90, 0})}));
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].parts, SampleParts::pose);
    EXPECT_EQ(p.samples[0].pose.position, gi::dvec3(1, 2, 3));
    EXPECT_NEAR(p.samples[0].pose.rotation.y, std::sqrt(0.5), 1e-7);
    EXPECT_EQ(p.samples[0].measured_s, 100.5);
    EXPECT_FALSE(parse_osc(bundle(0, 1, {message("/tracker/a/position", {1, 2, 3})})).samples.at(0).measured_s)
        << "'at once' is no time";
}

TEST(Osc, BodiesMayBeNamedByAnArgument)
{
    lo_message const m = lo_message_new();
    lo_message_add_string(m, "HMD-1");
    for (float const v : {0.f, 1.f, 2.f, 0.f, 0.f, 0.f, 1.f}) lo_message_add_float(m, v);
    std::size_t size = lo_message_length(m, "/VMC/Ext/Hmd/Pos");
    Bytes bytes(size);
    lo_message_serialise(m, "/VMC/Ext/Hmd/Pos", bytes.data(), &size);
    lo_message_free(m);
    TrackerPacket const p = parse_osc(bytes);
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].body, "HMD-1");
    EXPECT_EQ(p.samples[0].pose.position, gi::dvec3(0, 1, 2));
}

TEST(Osc, PatternsAreConfigurable)
{
    std::vector<OscPattern> const mine{{"/lab/<body>/wand", "_ z y x [buttons]"}};
    check(mine[0]);
    TrackerPacket const p = parse_osc(message("/lab/7/wand", {99, 1, 2, 3, 4}), mine);
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].pose.position, gi::dvec3(3, 2, 1));
    EXPECT_EQ(p.samples[0].buttons, 4u);
    EXPECT_EQ(parse_osc(message("/tracker/head/pose", {1, 2, 3, 0, 0, 0, 1}), mine).ignored, 1u);
    for (OscPattern const& wrong :
         {OscPattern{"lab/<body>", "x y z"}, OscPattern{"/lab", "x y z"}, OscPattern{"/<body>", "x y"},
          OscPattern{"/<body>", "x y z x"}, OscPattern{"/<body>", "x y z qx qy qz"},
          OscPattern{"/<body>", "height"}, OscPattern{"/<body>", "axes buttons"},
          OscPattern{"/<body>", "qx qy qz qw yaw pitch roll"}})
        EXPECT_THROW(check(wrong), gi::InputError) << wrong.path << " " << wrong.arguments;
    for (OscPattern const& p2 : default_osc_patterns()) EXPECT_NO_THROW(check(p2)) << p2.path;
}

TEST(Osc, ReadsTheControlsOfAWand)
{
    TrackerPacket const p = parse_osc(
        bundle(0, 1, {message("/tracker/wand/axes", {0.5f, -1}), message("/tracker/wand/buttons", {6})}));
    ASSERT_EQ(p.samples.size(), 2u);
    EXPECT_EQ(p.samples[0].parts, SampleParts::buttons);
    EXPECT_EQ(p.samples[0].axes, (std::vector<double>{0.5, -1}));
    EXPECT_EQ(p.samples[1].buttons, 6u);
    EXPECT_EQ(parse_osc(message("/tracker/wand/axes", std::vector<float>(40, 1.0f))).samples[0].axes.size(),
              kMostAxes);
    EXPECT_EQ(parse_osc(message("/tracker/wand/axes", {1, std::numeric_limits<float>::infinity()})).malformed, 1u);
    EXPECT_EQ(parse_osc(message("/tracker/wand/axes", {})).malformed, 1u);
    TrackerSample wand;
    wand.body = "wand";
    wand.axes = {0.25, 1};
    TrackerPacket const again = parse_osc(format_osc({wand}, 1));
    ASSERT_EQ(again.samples.size(), 2u);
    EXPECT_EQ(again.samples[1].axes, wand.axes);
}

TEST(Osc, CountsWhatIsMalformed)
{
    float const nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(parse_osc(message("/tracker/head/pose", {1, 2, 3})).malformed, 1u);
    EXPECT_EQ(parse_osc(message("/tracker/head/pose", {1, 2, 3, 0, 0, 0, 2})).malformed, 1u);
    EXPECT_EQ(parse_osc(message("/tracker/head/pose", {1, nan, 3, 0, 0, 0, 1})).malformed, 1u);
    EXPECT_EQ(parse_osc(message("/tracker/head/position", {1, 2, 3, 4, 5, 6})).malformed, 1u);
    EXPECT_EQ(parse_osc(message("/other", {1})).ignored, 1u);
    EXPECT_EQ(parse_osc(Bytes{}).malformed, 1u);
    Bytes const good = message("/tracker/head/pose", {1, 2, 3, 0, 0, 0, 1});
    for (std::size_t n = 0; n < good.size(); ++n)
        EXPECT_EQ(parse_osc(std::span(good).first(n)).malformed, 1u) << n << " bytes of " << good.size();
    Bytes nested = good;
    for (int i = 0; i < 20; ++i) nested = bundle(0, 1, {nested});
    EXPECT_EQ(parse_osc(nested).malformed, 1u);
}

TEST(Osc, WritesWhatItReads)
{
    TrackerSample s;
    s.body = "left_hand";
    s.pose = {{0.1, 1.7, -2.25}, gi::exp_rotation({0.3, -0.7, 1.1})};
    s.measured_s = 1234567.125;
    s.buttons = 0x80000001u;
    TrackerPacket const p = parse_osc(format_osc({s}, 1234567890123ull));
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].body, s.body);
    EXPECT_EQ(p.samples[0].pose.position, s.pose.position);
    EXPECT_LT(angle_between(p.samples[0].pose.rotation, s.pose.rotation), 1e-12);
    EXPECT_EQ(p.samples[0].measured_s, s.measured_s);
    EXPECT_EQ(p.samples[0].buttons, s.buttons);
    EXPECT_EQ(p.samples[0].frame, 1234567890123ull);
}

} // namespace
} // namespace viewer::test
