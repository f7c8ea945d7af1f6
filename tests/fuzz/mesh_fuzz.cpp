// Any bytes as a model for Assimp; the first byte selects the format. The result must be a scene or an InputError,
// even if the child process that tries the file first crashes.

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"

#include <filesystem>
#include <fstream>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    if (size < 1) return 0;
    char const* const ends[]{".obj", ".ply", ".stl", ".off", ".dae", ".x", ".nff", ".ase"};
    std::filesystem::path const file =
        std::filesystem::temp_directory_path() / ("mesh_fuzz_" + std::to_string(getpid()) + ends[data[0] % 8]);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(data + 1), std::streamsize(size - 1));
    gi::Report report;
    try {
        gi::build_world(std::make_shared<gi::Scene const>(gi::load_assimp(file, report)), 0, report);
    } catch (gi::InputError const&) {
    }
    std::filesystem::remove(file);
    return 0;
}
