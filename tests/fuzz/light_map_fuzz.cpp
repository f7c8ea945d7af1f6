// Any bytes as an environment map, the first says which format: a map or an InputError, never anything else.

#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "gi/core/error.h"

#include <fstream>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    if (size < 1) return 0;
    char const* const ends[]{".exr", ".hdr", ".png"};
    std::filesystem::path const file = std::filesystem::temp_directory_path() /
                                       ("light_map_fuzz_" + std::to_string(getpid()) + ends[data[0] % 3]);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(data + 1), std::streamsize(size - 1));
    try {
        cv::Mat const map = ar::read_map(file);
        ar::check_map(map, "again");
    } catch (gi::InputError const&) {
    }
    std::filesystem::remove(file);
    return 0;
}
