#include "ar/scene/occlusion.h"
#include "ar/scene/read_values.h"

namespace ar {
namespace {

using gi::Yaml;

/// A name, or a map with `source`.
FramePictures pictures(Yaml const& y, std::filesystem::path const& folder)
{
    FramePictures p;
    if (y.is_text()) {
        p.source = folder / y.text();
        return p;
    }
    y.only_keys({"source", "first", "rate_hz"});
    p.source = folder / y.needed("source", "depth").text();
    if (y.has("first")) p.first = y.at("first").integer(-1000000000, 1000000000);
    if (y.has("rate_hz")) p.rate_hz = y.at("rate_hz").number(0.01, 1000);
    return p;
}

} // namespace

OcclusionPictures read_occlusion(Yaml const& o, std::filesystem::path const& folder)
{
    o.only_keys(
        {"depth", "matte", "camera", "camera_from_depth", "metres_per_unit", "margin_m", "soft_m", "soft_px"});
    OcclusionPictures out;
    if (o.has("depth")) out.depth = pictures(o.at("depth"), folder);
    if (o.has("matte")) out.matte = pictures(o.at("matte"), folder);
    if (!out.depth && !out.matte)
        throw o.error("neither 'depth' nor 'matte'", "nothing says what is in front", "name a folder of pictures");
    for (char const* key : {"camera", "camera_from_depth", "metres_per_unit", "margin_m", "soft_m", "soft_px"})
        if (!out.depth && o.has(key))
            throw o.at(key).error("'" + std::string(key) + "' without 'depth'", "it is about depth pictures",
                                  "add depth, or remove the key");
    if (o.has("camera")) out.camera = folder / o.at("camera").text();
    if (o.has("camera_from_depth")) {
        if (out.camera.empty())
            throw o.at("camera_from_depth")
                .error("no 'camera'", "without it depths are registered to the frames, with their camera",
                       "add the calibration of the depth camera");
        o.at("camera_from_depth").only_keys({"position_m", "rotation_deg", "rotation_xyzw"});
        out.camera_from_depth = read_pose(o.at("camera_from_depth"));
    }
    if (o.has("metres_per_unit")) out.metres_per_unit = o.at("metres_per_unit").number(1e-9, 1e6);
    if (o.has("margin_m")) out.settings.margin_m = o.at("margin_m").number(0, 10);
    if (o.has("soft_m")) out.settings.soft_m = o.at("soft_m").number(0, 10);
    if (o.has("soft_px")) out.settings.soft_px = o.at("soft_px").number(0, 50);
    return out;
}

} // namespace ar
