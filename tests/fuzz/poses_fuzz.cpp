// Any text as poses of a camera: poses or an InputError, never anything else.

#include "ar/pose/pose_import.h"
#include "gi/core/error.h"

#include <cmath>

namespace {

void any(auto const& parse)
{
    try {
        parse();
    } catch (gi::InputError const&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::vector<char> const text(data, data + size);
    try {
        auto const poses = ar::parse_poses({text.data(), text.size()}, "fuzz");
        auto const again = ar::parse_poses(ar::format_poses(poses), "again");
        if (again.size() != poses.size()) __builtin_trap();
        for (auto const& p : poses)
            if (!(std::abs(glm::length(p.world_from_camera.rotation) - 1) < 1e-9)) __builtin_trap();
        ar::pose_at(poses, 0.5 * (poses.front().time_s + poses.back().time_s), 1e16);
    } catch (gi::InputError const&) {
    }
    std::string const whole(text.begin(), text.end());
    any([&] { ar::parse_colmap_images(whole, "fuzz", {30}); });
    any([&] { ar::parse_chan(whole, "fuzz", {30}); });
    any([&] { ar::parse_blender_json(whole, "fuzz", {}); });
    return 0;
}
