#include "viewer/protocol/remote/request.h"

#include <fmt/format.h>

namespace viewer {

std::span<RequestRule const> request_rules()
{
    using enum ArgumentType;
    using enum Presence;
    static std::vector<RequestRule> const rules{
        {"ping", "does nothing", "`{}`", {}},
        {"stats",
         "what --stats knows at this moment",
         "counts, times and losses by name; `at_rest`: the window shows the newest frame, and no other is due "
         "until something changes",
         {}},
        {"load",
         "shows another scene",
         "`{}`, once its first frame was shown",
         {{"scene", text, required, "a file, or the name of a generated scene"}}},
        {"set",
         "sets what the panel and the keys can set",
         "`{}`",
         {{"key", text, required, "e.g. `exposure`, `light.0.intensity`"},
          {"value", any, required, "of the type of the key"}}},
        {"get",
         "reads a setting",
         "`{\"value\": ...}`",
         {{"key", text, required, "one that `set` takes, but no edit of the scene: e.g. `exposure`"}}},
        {"camera",
         "moves the camera; without arguments only tells where it is",
         "`{\"position\": point, \"rotation\": rotation, \"fov_deg\": number}`",
         {{"name", text, optional, "a camera of the scene"},
          {"position", point, optional, "m, in the world"},
          {"look_at", point, optional, "m, in the world; not together with `rotation`"},
          {"rotation", rotation, optional, "world from camera, which looks along -Z"},
          {"fov_deg", number, optional, "vertical field of view, degrees"}}},
        {"play",
         "lets the scene's animations run",
         "`{}`",
         {{"speed", number, optional, "s of the scene per s; 1 if it is not given"}}},
        {"pause", "holds the scene's animations", "`{}`", {}},
        {"seek", "sets the time of the scene's animations", "`{}`", {{"time_s", number, required, "s"}}},
        {"screenshot",
         "saves the first frame that has seen all earlier requests",
         "`{\"file\": ..., \"frame\": ...}`, once it is on the disk",
         {{"file", text, required, ".png as shown, .exr with all layers"},
          {"view", integer, optional,
           "one of several views alone, from 0; else .png holds the window and .exr view 0"},
          {"converged", boolean, optional, "wait until the picture refines no further: 4096 paths per pixel"}}},
        {"key",
         "a key of the keyboard, as if pressed",
         "`{\"frame\": ..., \"after_ms\": ..., \"reprojected\": ...}`, once a frame was shown that has seen it",
         {{"key", text, required, "e.g. `w`, `F1`, `escape`"},
          {"action", text, optional, "`tap` if it is not given", "tap press release"}}},
        {"pick",
         "what lies under a pixel",
         "`{\"object\": name or null, \"material\": ..., \"position\": point, \"distance_m\": ...}`",
         {{"x_px", number, required, "from the left edge of the first view"},
          {"y_px", number, required, "from its top edge"},
          {"select", boolean, optional, "also select it, as a click does"}}},
        {"session",
         "of an experiment that runs (`study run`): what it is at, or a wish of the experimenter",
         "`{\"doing\": ..., \"trials_done\": ..., ...}`",
         {{"action", ArgumentType::text, Presence::required, "what to do", "status pause go_on skip abort note"},
          {"text", ArgumentType::text, Presence::optional, "of the note"}}},
        {"quit", "ends the program in order", "`{}`", {}},
    };
    return rules;
}

std::string requests_as_text()
{
    std::string text;
    for (RequestRule const& r : request_rules()) {
        std::string call = r.name;
        for (ArgumentRule const& a : r.arguments)
            call += a.presence == Presence::optional ? fmt::format(" [{}]", a.name) : " " + std::string(a.name);
        text += fmt::format("  {}: {}\n", call, r.meaning);
    }
    return text;
}

} // namespace viewer
