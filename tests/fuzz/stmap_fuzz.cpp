// Any bytes as the STMap of a camera of 8 x 6 pixels: a lens whose pixels have rays, or an InputError.

#include "ar/calibration/stmap.h"
#include "gi/core/error.h"

#include <cmath>
#include <fstream>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::filesystem::path const file =
        std::filesystem::temp_directory_path() / ("stmap_fuzz_" + std::to_string(getpid()) + ".exr");
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<char const*>(data), std::streamsize(size));
    ar::CameraModel pinhole;
    pinhole.size_px = {8, 6};
    pinhole.fx = pinhole.fy = 7;
    pinhole.cx = 3.5;
    pinhole.cy = 2.5;
    try {
        ar::CameraModel const camera = ar::with_stmap(pinhole, file);
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 8; ++x) {
                auto const ray = ar::direction_of(camera, {x, y});
                if (!ray || !std::isfinite(ray->x + ray->y + ray->z)) __builtin_trap();
                if (auto const p = ar::project(camera, *ray); p && !std::isfinite(p->x + p->y)) __builtin_trap();
            }
    } catch (gi::InputError const&) {
    }
    std::filesystem::remove(file);
    return 0;
}
