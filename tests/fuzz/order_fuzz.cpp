// Any bytes as a frame order: an order that comes back the same, or an InputError.

#include "gi/core/error.h"
#include "viewer/protocol/frame_command.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    try {
        viewer::FrameCommand const order = viewer::command_from_bytes({data, size});
        if (!(viewer::command_from_bytes(viewer::to_bytes(order)) == order)) std::abort();
    } catch (gi::InputError const&) {
    }
    return 0;
}
