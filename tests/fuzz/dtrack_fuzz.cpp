// Any bytes as a packet of ART DTrack: samples that are finite rotations and places, never anything else.

#include "viewer/devices/tracking/dtrack.h"

#include "tests/fuzz/expect_samples.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    // A copy of its exact size, so that reading past the end is seen.
    std::vector<char> const packet(data, data + size);
    viewer::expect_samples(viewer::parse_dtrack({packet.data(), packet.size()}));
    return 0;
}
