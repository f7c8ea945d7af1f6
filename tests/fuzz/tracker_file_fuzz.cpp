// Any text as recorded poses: poses or an InputError, never anything else.

#include "gi/core/error.h"
#include "tests/fuzz/expect_samples.h"
#include "viewer/devices/tracking/tracker_file.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::vector<char> const text(data, data + size);
    try {
        viewer::TrackerPacket packet;
        packet.samples = viewer::parse_tracker_file({text.data(), text.size()}, "fuzz");
        viewer::expect_samples(packet);
        viewer::FileTracker tracker(packet.samples, "fuzz", viewer::AtEnd::stop);
        std::vector<viewer::TrackerSample> played;
        tracker.poll(0, played);
        tracker.poll(1e16, played);
        if (played.size() != packet.samples.size()) __builtin_trap();
    } catch (gi::InputError const&) {
    }
    return 0;
}
