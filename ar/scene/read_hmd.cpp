#include "ar/scene/read_values.h"

namespace ar {

HmdCameras read_hmd(gi::Yaml const& y, std::filesystem::path const& folder)
{
    y.only_keys({"head_from_camera", "plane_m", "right"});
    HmdCameras hmd;
    if (y.has("head_from_camera")) read_turned(y.at("head_from_camera"), hmd.head_from_camera);
    if (y.has("plane_m")) hmd.plane_m = y.at("plane_m").number(0.05, 1e4);
    if (!y.has("right")) return hmd;
    gi::Yaml const r = y.at("right");
    r.only_keys({"source", "camera", "left_from_right"});
    for (char const* needed : {"source", "camera", "left_from_right"})
        if (!r.has(needed))
            throw r.error(std::string("no '") + needed + "'", "the right eye has a camera of its own",
                          "add it, or remove `right` to use one camera for both eyes");
    RightCamera right;
    std::string const name = r.at("source").text();
    right.source = is_device(name) ? name : (folder / name).string();
    right.calibration = folder / r.at("camera").text();
    read_turned(r.at("left_from_right"), right.left_from_right);
    hmd.right = right;
    return hmd;
}

} // namespace ar
