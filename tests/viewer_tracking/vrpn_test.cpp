// VRPN: what its messages mean, and a server that comes, goes and sends nonsense.

#include "gi/core/error.h"
#include "gi/core/pose.h"
#include "tests/support/processor_time.h"
#include "tests/viewer_tracking/vrpn_server.h"
#include "viewer/devices/tracking/tracker_hub.h"
#include "viewer/devices/tracking/vrpn_tracker.h"

#include <fmt/format.h>
#include <thread>

namespace viewer::test {
namespace {

/// What a reader makes of bytes after the greeting and names.
TrackerPacket read(VrpnBytes const& bytes, VrpnDevices const& devices = {"Tracker0", ""})
{
    VrpnReader reader(devices);
    TrackerPacket packet;
    EXPECT_TRUE(reader.take_stream(vrpn_hello(), packet));
    EXPECT_TRUE(reader.take_stream(vrpn_names(), packet));
    EXPECT_FALSE(reader.hears_device()) << "only named";
    EXPECT_EQ(packet.malformed + packet.ignored, 0u);
    reader.take_stream(bytes, packet);
    return packet;
}

TEST(VrpnMessages, APoseIsInMetresWithItsQuaternionXyzw)
{
    double const s = std::sqrt(0.5);
    TrackerPacket const p = read(vrpn_message(0, 0, vrpn_pose(3, {0.5, 1.7, -2, 0, s, 0, s}), 1234.25));
    ASSERT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.samples[0].body, "3");
    EXPECT_EQ(p.samples[0].parts, SampleParts::pose);
    EXPECT_EQ(p.samples[0].pose.position, gi::dvec3(0.5, 1.7, -2));
    // A quarter turn about +y: what looked along -z looks along -x.
    EXPECT_LT(glm::distance(p.samples[0].pose.rotation * gi::dvec3(0, 0, -1), {-1, 0, 0}), 1e-12);
    EXPECT_DOUBLE_EQ(*p.samples[0].measured_s, 1234.25);
}

TEST(VrpnMessages, ComeInAnyPortions)
{
    VrpnBytes all = vrpn_hello();
    for (VrpnBytes const& b : {vrpn_names(), vrpn_message(0, 0, vrpn_pose(0, {1, 2, 3, 0, 0, 0, 1}))})
        all.insert(all.end(), b.begin(), b.end());
    VrpnReader reader({"Tracker0", ""});
    TrackerPacket p;
    for (unsigned char const byte : all) ASSERT_TRUE(reader.take_stream({&byte, 1}, p));
    EXPECT_EQ(p.samples.size(), 1u);
    EXPECT_EQ(p.malformed + p.ignored, 0u);
}

TEST(VrpnMessages, ControlsAreThoseOfTheChosenDevice)
{
    VrpnBytes bytes;
    auto const add = [&bytes](VrpnBytes const& b) { bytes.insert(bytes.end(), b.begin(), b.end()); };
    add(vrpn_message(2, 0, vrpn_integers({1, 1})));          // button 1 of Tracker0
    add(vrpn_message(3, 1, vrpn_integers({4, 1, 0, 0, 1}))); // all buttons of Button0
    add(vrpn_message(2, 1, vrpn_integers({0, 0})));          // its first is let go
    add(vrpn_message(4, 1, vrpn_analogs({0.5, -1})));
    add(vrpn_message(4, 0, vrpn_analogs({0.25})));
    TrackerPacket const own = read(bytes);
    ASSERT_EQ(own.samples.size(), 2u);
    EXPECT_EQ(own.samples[0].body, kDeviceControls);
    EXPECT_EQ(*own.samples[0].buttons, 2u);
    EXPECT_EQ(own.samples[1].axes, std::vector<double>{0.25});
    EXPECT_EQ(own.ignored, 0u) << "another device's messages are not ours to count";
    TrackerPacket const other = read(bytes, {"Tracker0", "Button0"});
    ASSERT_EQ(other.samples.size(), 3u);
    EXPECT_EQ(*other.samples[0].buttons, 0b1001u);
    EXPECT_EQ(*other.samples[1].buttons, 0b1000u);
    EXPECT_EQ(other.samples[2].axes, (std::vector<double>{0.5, -1}));
}

TEST(VrpnMessages, MalformedOnesAreCounted)
{
    VrpnBytes little; // a pose in the wrong byte order
    put_little(little, 0, 8);
    for (double const v : {0.1, 1.7, -0.5, 0.0, 0.6, 0.0, 0.8})
        put_little(little, std::bit_cast<std::uint64_t>(v), 8);
    VrpnBytes cut = vrpn_pose(0, {1, 2, 3, 0, 0, 0, 1});
    cut.resize(60);
    VrpnBytes name = vrpn_name("x");
    name[3] = 200; // longer than the message
    for (VrpnBytes const& bytes :
         {vrpn_message(0, 0, little), vrpn_message(0, 0, cut), vrpn_message(0, 0, {}),
          vrpn_message(0, 0, vrpn_pose(-1, {1, 2, 3, 0, 0, 0, 1})),
          vrpn_message(0, 0, vrpn_pose(0, {1, 2, std::nan(""), 0, 0, 0, 1})),
          vrpn_message(0, 0, vrpn_pose(0, {1, 2, 3, 0, 0, 0, 0})),
          vrpn_message(1, 0, vrpn_pose(0, {1, 2, 3, 0, 0, 0, 1})), // a velocity without its dt
          vrpn_message(2, 0, vrpn_integers({1})), vrpn_message(3, 0, vrpn_integers({5, 1})),
          vrpn_message(4, 0, vrpn_integers({2, 0})), vrpn_message(-1, 5, name),
          vrpn_message(-2, -7, vrpn_name("y"))}) {
        TrackerPacket const p = read(bytes);
        EXPECT_TRUE(p.samples.empty());
        EXPECT_EQ(p.malformed, 1u);
    }
    TrackerPacket const velocity = read(vrpn_message(1, 0, vrpn_pose(0, {1, 2, 3, 0, 0, 0, 1, 0.1})));
    EXPECT_EQ(velocity.ignored, 1u);
    EXPECT_EQ(velocity.malformed, 0u);
    EXPECT_EQ(read(vrpn_message(9, 0, {})).ignored, 1u) << "a type that was not named";
}

TEST(VrpnMessages, AnotherProtocolIsNamed)
{
    auto const fault = [](VrpnBytes const& bytes) {
        VrpnReader reader({"Tracker0", ""});
        TrackerPacket p;
        bool good = reader.take_stream(bytes, p);
        if (good) good = reader.take_stream(vrpn_names(), p);
        EXPECT_FALSE(good);
        EXPECT_FALSE(reader.take_stream(vrpn_hello(), p)) << "nothing more is read";
        return reader.fault();
    };
    EXPECT_EQ(fault({'H', 'T', 'T', 'P'}), "it is no VRPN server");
    EXPECT_EQ(fault(vrpn_hello("vrpn: ver. 06.05")), "the server has another version of VRPN than 07.xx");
    VrpnBytes short_one = vrpn_hello();
    put_big(short_one, 3, 4);
    short_one.resize(short_one.size() + 20);
    EXPECT_EQ(fault(short_one), "a message has an impossible length");
    VrpnBytes long_one = vrpn_hello();
    put_big(long_one, 0x7fffffff, 4);
    long_one.resize(long_one.size() + 20);
    EXPECT_EQ(fault(long_one), "a message has an impossible length");
}

TEST(VrpnAddress, HasADeviceAndAServer)
{
    auto const a = parse_vrpn_address("Tracker0@art.lab");
    ASSERT_TRUE(a);
    EXPECT_EQ(a->device + "|" + a->host + fmt::format("|{}", a->port), "Tracker0|art.lab|3883");
    EXPECT_FALSE(a->tcp_only);
    EXPECT_EQ(parse_vrpn_address("T@tcp://10.0.0.1:4000")->port, 4000);
    EXPECT_TRUE(parse_vrpn_address("T@tcp://10.0.0.1:4000")->tcp_only);
    EXPECT_EQ(parse_vrpn_address("T@[::1]:4000")->host, "::1");
    for (char const* wrong :
         {"", "Tracker0", "@host", "T@", "T@host:", "T@host:0", "T@host:65536", "T@ho st", "T@[::1"})
        EXPECT_FALSE(parse_vrpn_address(wrong)) << wrong;
}

TrackerSettings settings_for(int port)
{
    TrackerSettings s;
    s.type = TrackerType::vrpn;
    s.device = fmt::format("Tracker0@127.0.0.1:{}", port);
    s.head.id = "0";
    s.right_hand.id = "2";
    return s;
}

template <class Condition>
bool becomes(TrackerHub& hub, Condition const& condition)
{
    for (int k = 0; k < 2000; ++k) {
        hub.poll(steady_seconds());
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

TEST(VrpnTracker, FollowsAServerOverTcpAndUdp)
{
    VrpnServer server;
    TrackerHub hub({settings_for(server.port())}, Polling::by_caller);
    hub.poll(steady_seconds());
    ASSERT_TRUE(server.accept_client());
    hub.poll(steady_seconds());
    VrpnBytes const hello = server.received();
    ASSERT_EQ(hello.size(), 24u);
    EXPECT_EQ(std::string(hello.begin(), hello.begin() + 14), "vrpn: ver. 07.");
    server.send(vrpn_hello());
    ASSERT_TRUE(becomes(hub, [&] { return hub.report(0)[0].counts.connects == 1; }));
    EXPECT_EQ(hub.report(0)[0].fault, "the server has no device 'Tracker0', or it is silent");
    server.send(vrpn_names());
    server.send(vrpn_message(0, 0, vrpn_pose(0, {0, 1.7, 1, 0, 0, 0, 1})));
    ASSERT_TRUE(becomes(hub, [&] { return hub.at(steady_seconds()).tracked.head.has_value(); }));
    EXPECT_LT(glm::distance(hub.at(steady_seconds()).tracked.head->position, {0, 1.7, 1}), 1e-9);
    EXPECT_EQ(hub.report(0)[0].fault, "");

    // The wish for UDP packets: type -3, the port where the sender would be, then our address.
    VrpnBytes const wishes = server.received();
    ASSERT_GE(wishes.size(), 40u);
    auto const word = [&](std::size_t at) {
        return std::uint32_t(wishes[at]) << 24 | std::uint32_t(wishes[at + 1]) << 16 |
               std::uint32_t(wishes[at + 2]) << 8 | wishes[at + 3];
    };
    EXPECT_EQ(std::int32_t(word(16)), -3);
    EXPECT_STREQ(reinterpret_cast<char const*>(wishes.data()) + 24, "127.0.0.1");
    UdpSender const udp("127.0.0.1", int(word(12)));
    VrpnBytes both = vrpn_message(0, 0, vrpn_pose(2, {0.3, 1.1, 0.5, 0, 0, 0, 1}));
    VrpnBytes const button = vrpn_message(2, 0, vrpn_integers({4, 1}));
    both.insert(both.end(), button.begin(), button.end());
    EXPECT_TRUE(udp.send(both));
    ASSERT_TRUE(becomes(hub, [&] { return hub.at(steady_seconds()).tracked.right_hand.has_value(); }));
    EXPECT_EQ(hub.at(steady_seconds()).buttons[std::size_t(Body::right_hand)], 16u);
}

TEST(VrpnTracker, WaitsForItsServerAndComesBackToIt)
{
    std::unique_ptr<VrpnServer> server = std::make_unique<VrpnServer>();
    int const port = server->port();
    server.reset();
    TrackerHub hub({settings_for(port)}, Polling::by_caller);
    long const before = gi::test::waits();
    for (int k = 0; k < 20; ++k) hub.poll(steady_seconds());
    EXPECT_LT(gi::test::waits() - before, 20) << "polling waits for nobody";
    EXPECT_EQ(hub.report(0)[0].fault, "Connection refused");
    for (std::uint64_t round = 1; round <= 2; ++round) {
        server = std::make_unique<VrpnServer>(port);
        ASSERT_TRUE(becomes(hub, [&] { return server->accept_client(0); }));
        server->send(vrpn_hello());
        server->send(vrpn_names());
        server->send(vrpn_message(0, 0, vrpn_pose(0, {0, 1.7, 1, 0, 0, 0, 1})));
        ASSERT_TRUE(becomes(hub, [&] { return hub.report(0)[0].fault.empty(); }));
        EXPECT_EQ(hub.report(0)[0].counts.connects, round);
        server->received(); // unread bytes would make the end a reset
        server.reset();
        ASSERT_TRUE(becomes(hub, [&] { return hub.report(0)[0].counts.disconnects == round; }));
        EXPECT_EQ(hub.report(0)[0].fault, "the server closed the connection");
    }
}

TEST(VrpnTracker, DropsAServerThatSpeaksSomethingElse)
{
    VrpnServer server;
    TrackerHub hub({settings_for(server.port())}, Polling::by_caller);
    hub.poll(steady_seconds());
    ASSERT_TRUE(server.accept_client());
    server.send({'S', 'S', 'H', '-', '2', '.', '0'});
    ASSERT_TRUE(becomes(hub, [&] { return hub.report(0)[0].fault == "it is no VRPN server"; }));
    EXPECT_EQ(hub.report(0)[0].counts.connects, 0u);
}

TEST(VrpnTracker, RefusesAddressesWithoutAServer)
{
    TrackerSettings s = settings_for(3883);
    s.device = "Tracker0";
    EXPECT_THROW(check(s), gi::InputError);
    EXPECT_THROW(VrpnTracker({"Tracker0", "no.such.host.invalid"}, ""), gi::InputError);
}

} // namespace
} // namespace viewer::test
