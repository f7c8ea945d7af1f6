// Any bytes as what a VRPN server sends, over TCP in two portions and as a UDP packet: samples that are finite
// rotations and places, never anything else.

#include "tests/fuzz/expect_samples.h"
#include "viewer/devices/tracking/vrpn_messages.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    // Copies of their exact size, so that reading past the end is seen.
    std::size_t const half = size / 2;
    std::vector<unsigned char> const first(data, data + half), second(data + half, data + size);
    viewer::VrpnReader stream({"Tracker0", "Button0"});
    viewer::TrackerPacket packet;
    if (stream.take_stream(first, packet)) stream.take_stream(second, packet);
    viewer::expect_samples(packet);
    viewer::TrackerPacket datagram;
    stream.take_datagram(std::vector<unsigned char>(data, data + size), datagram);
    viewer::expect_samples(datagram);
    return 0;
}
