#include "viewer/engine/scene_start.h"

#include "gi/core/error.h"

namespace viewer {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(std::string const& why)
{
    throw gi::InputError("the start of a scene cannot be read", why, "give the scene's name alone");
}

} // namespace

Json to_json(SceneStart const& s)
{
    gi::Camera const& c = s.camera;
    Json j{{"pixels", s.pixels}, {"yfov_rad", c.yfov_rad}};
    if (c.orthographic) j["ymag_m"] = c.ymag_m;
    if (c.aperture_radius_m > 0) {
        j["aperture_radius_m"] = c.aperture_radius_m;
        j["focus_distance_m"] = c.focus_distance_m;
    }
    Json& m = j["world_from_camera"] = Json::array();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m.push_back(c.world_from_camera[column][row]);
    return j;
}

SceneStart start_from_json(Json const& j)
{
    SceneStart s;
    try {
        s.pixels = j.at("pixels").get<double>();
        s.camera.yfov_rad = j.at("yfov_rad").get<double>();
        s.camera.orthographic = j.contains("ymag_m");
        s.camera.ymag_m = j.value("ymag_m", s.camera.ymag_m);
        s.camera.aperture_radius_m = j.value("aperture_radius_m", 0.0);
        s.camera.focus_distance_m = j.value("focus_distance_m", 0.0);
        Json const& m = j.at("world_from_camera");
        if (m.size() != 16) refuse("a camera's matrix has 16 numbers");
        for (std::size_t i = 0; i < 16; ++i)
            s.camera.world_from_camera[int(i / 4)][int(i % 4)] = m.at(i).get<double>();
    } catch (Json::exception const& e) {
        refuse(e.what());
    }
    constexpr double kMostPixels = double(CommandLimits::size_px) * CommandLimits::size_px * CommandLimits::views;
    if (!(s.pixels >= 1 && s.pixels <= kMostPixels)) refuse("its number of pixels is out of range");
    FrameCommand checked;
    checked.views.push_back({"start", s.camera, 1, 1});
    check_command(checked);
    return s;
}

Change to_change(SceneChange const& c)
{
    if (!c.start) return {"scene", c.name};
    Change change{"scene", {{"file", c.name}, {"start", to_json(*c.start)}}};
    if (!c.files.empty()) change.value["files"] = c.files;
    return change;
}

SceneChange scene_change_of(Change const& c)
{
    auto const named = [&](Json const& name) {
        if (!name.is_string())
            throw gi::InputError("'scene' = " + c.value.dump(-1, ' ', false, Json::error_handler_t::replace),
                                 "a scene's name is a text", "set a file or a built-in scene");
        return name.get<std::string>();
    };
    if (!c.value.is_object()) return {named(c.value), {}};
    SceneChange s{named(c.value.value("file", Json())), {}};
    if (c.value.contains("start")) s.start = start_from_json(c.value.at("start"));
    if (c.value.contains("files")) s.files = file_hashes_from_json(c.value.at("files"));
    return s;
}

} // namespace viewer
