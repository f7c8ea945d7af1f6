// Any bytes as a PLY file: a model or a reported reason. Runs in this process, since mesh_fuzz starts a child per input.

#include "gi/scene/load/ply/ply_model.h"

#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    gi::ImportedFiles notes;
    try {
        gi::read_ply({reinterpret_cast<char const*>(data), size}, notes, "a.ply");
    } catch (std::runtime_error const&) {
    }
    return 0;
}
