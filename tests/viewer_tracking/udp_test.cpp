// Sockets: what is bound, and what arrives.

#include "gi/core/error.h"
#include "viewer/devices/tracking/udp_tracker.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>

namespace viewer::test {
namespace {

/// An IPv4 address of this machine that is not the loopback; empty = it has none.
std::string outer_address()
{
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return {};
    std::string found;
    for (ifaddrs const* i = list; i != nullptr; i = i->ifa_next) {
        if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET || (i->ifa_flags & IFF_LOOPBACK) != 0)
            continue;
        char text[INET_ADDRSTRLEN] = "";
        inet_ntop(AF_INET, &reinterpret_cast<sockaddr_in const*>(i->ifa_addr)->sin_addr, text, sizeof text);
        found = text;
    }
    freeifaddrs(list);
    return found;
}

bool arrives(UdpReceiver& receiver, std::string const& address)
{
    unsigned char const byte[] = {42};
    UdpSender(address, receiver.port()).send(byte);
    pollfd wait{receiver.descriptor(), POLLIN, 0};
    ::poll(&wait, 1, 100);
    return receiver.receive().has_value();
}

TEST(Udp, BindsTheLoopbackAndNothingElse)
{
    UdpReceiver receiver("127.0.0.1", 0);
    EXPECT_EQ(receiver.address(), "127.0.0.1");
    EXPECT_TRUE(arrives(receiver, "127.0.0.1"));
    EXPECT_FALSE(arrives(receiver, "127.0.0.2")) << "not even another address of the loopback";
    if (outer_address().empty()) GTEST_SKIP() << "SKIPPED: this machine has no address but the loopback's";
    EXPECT_FALSE(arrives(receiver, outer_address()));
}

TEST(Udp, AllInterfacesHaveToBeAskedFor)
{
    TrackerCounts const none{};
    EXPECT_EQ(make_osc_tracker("127.0.0.1", 0)->counts(), none);
    UdpReceiver all("0.0.0.0", 0);
    EXPECT_EQ(all.address(), "0.0.0.0");
    EXPECT_TRUE(arrives(all, "127.0.0.2"));
    for (char const* wrong : {"", "*", "any", "localhost", "256.0.0.1", "nosuchinterface0"})
        EXPECT_THROW(UdpReceiver(wrong, 0), gi::InputError) << wrong;
}

TEST(Udp, AnInterfaceIsItsAddress)
{
    UdpReceiver const receiver("lo", 0);
    EXPECT_EQ(receiver.address(), "127.0.0.1");
}

TEST(Udp, ErrorsAreTold)
{
    UdpReceiver const first("127.0.0.1", 0);
    EXPECT_THROW(UdpReceiver("127.0.0.1", first.port()), gi::InputError) << "in use";
    EXPECT_THROW(UdpReceiver("127.0.0.1", 65536), gi::InputError);
    EXPECT_THROW(UdpReceiver("192.0.2.1", 0), gi::InputError) << "no address of this machine";
    EXPECT_THROW(UdpSender("here", 9000), gi::InputError);
}

TEST(Udp, TheKernelSaysWhenItCame)
{
    UdpReceiver receiver("127.0.0.1", 0);
    UdpSender const sender("127.0.0.1", receiver.port());
    unsigned char const byte[] = {42};
    // Linux begins to stamp packets a moment after the first socket has asked for it; those before get the time of
    // their reading.
    bool is_stamped = false;
    for (int attempt = 0; attempt < 100 && !is_stamped; ++attempt) {
        double const before = steady_seconds();
        ASSERT_TRUE(sender.send(byte));
        double const after = steady_seconds();
        timespec const pause{0, 50'000'000};
        nanosleep(&pause, nullptr);
        auto const d = receiver.receive();
        ASSERT_TRUE(d);
        EXPECT_GT(d->received_s, before - 0.001);
        is_stamped = d->received_s < after + 0.02;
    }
    EXPECT_TRUE(is_stamped) << "it has the times when it was looked at, 50 ms later";
}

TEST(UdpTracker, CountsWhatComes)
{
    auto const tracker = make_dtrack_tracker("127.0.0.1", 0);
    std::vector<TrackerSample> got;
    auto const take = [&](std::string const& text) {
        tracker->take({reinterpret_cast<unsigned char const*>(text.data()), text.size()}, 1, got);
    };
    std::string const body = "6d 1 [0 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]\n";
    for (char const* frame : {"fr 1\n", "fr 2\n", "fr 5\n", "fr 4\n", "fr 4\n"}) take(frame + body);
    take("nonsense");
    take("6d x");
    TrackerCounts const c = tracker->counts();
    EXPECT_EQ(c.packets, 7u);
    EXPECT_EQ(c.samples, 4u);
    EXPECT_EQ(got.size(), 4u);
    EXPECT_EQ(c.lost, 1u);
    EXPECT_EQ(c.out_of_order, 1u);
    EXPECT_EQ(c.duplicate, 1u);
    EXPECT_EQ(c.ignored, 1u);
    EXPECT_EQ(c.malformed, 1u);
}

TEST(UdpTracker, FramesAreTimeWhereTheirRateIsKnown)
{
    auto const tracker = make_dtrack_tracker("127.0.0.1", 0, 60);
    std::string const text = "fr 120\n6d 1 [0 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]\n";
    std::vector<TrackerSample> got;
    tracker->take({reinterpret_cast<unsigned char const*>(text.data()), text.size()}, 1, got);
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0].measured_s, 2.0);
}

} // namespace
} // namespace viewer::test
