// Any text as the path of a camera: cameras that are finite at all times, or an InputError.

#include "gi/core/error.h"
#include "gi/scene/load/load.h"

#include <cmath>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    try {
        gi::CameraPath const path =
            gi::parse_camera_path(std::string(reinterpret_cast<char const*>(data), size), "fuzz");
        if (path.keys.empty()) std::abort();
        for (double const t : {-1e9, 0.0, 0.4, 1.7, 1e9}) {
            gi::Camera const camera = gi::camera_at(path, t, 0.8);
            if (!std::isfinite(camera.yfov_rad)) std::abort();
        }
    } catch (gi::InputError const&) {
    }
    return 0;
}
