// Any bytes as an OSC packet: samples that are finite rotations and places, never anything else.

#include "tests/fuzz/expect_samples.h"
#include "viewer/devices/tracking/osc.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    // A copy of its exact size, so that reading past the end is seen.
    std::vector<unsigned char> const packet(data, data + size);
    viewer::expect_samples(viewer::parse_osc(packet));
    return 0;
}
