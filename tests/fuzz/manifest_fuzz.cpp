// Any text as the manifest of a batch: tasks, or reported mistakes, never anything else.

#include "gi/core/error.h"
#include "viewer/batch/manifest.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(reinterpret_cast<char const*>(data), size);
    try {
        viewer::batch::ReadManifest const read = viewer::batch::read_manifest(text, "fuzz", {"render", "study"});
        if (read.mistakes.empty() && read.batch.tasks.empty()) std::abort();
    } catch (gi::InputError const&) {
    }
    return 0;
}
