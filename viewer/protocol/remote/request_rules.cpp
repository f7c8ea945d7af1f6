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
         "returns the current values of what `--stats` reports",
         "counts, times and losses by name; `at_rest`: true if the window shows the newest frame and none will "
         "follow until something changes",
         {}},
        {"load",
         "loads and shows a scene",
         "`{}`, once its first frame is shown",
         {{"scene", text, required, "a file, or the name of a generated scene"}}},
        {"set",
         "changes a setting or edits the scene, as the panel and the keys do",
         "`{}`",
         {{"key", text, required, "e.g. `exposure`, `quality`, `light.0.intensity`"},
          {"value", any, required, "new value, of the key's type"}}},
        {"get",
         "reads a setting",
         "`{\"value\": ...}`",
         {{"key", text, required,
           "a setting, e.g. `exposure`, or `quality` (null: its settings were set one by one); not an edit of the "
           "scene"}}},
        {"camera",
         "moves the camera and returns its pose; without arguments it only returns the pose",
         "`{\"position\": point, \"rotation\": rotation, \"fov_deg\": number}`",
         {{"name", text, optional, "name of a camera of the scene, to start from"},
          {"position", point, optional, "m, in the world"},
          {"look_at", point, optional, "m, in the world; not together with `rotation`"},
          {"rotation", rotation, optional, "world from camera; the camera looks along -Z"},
          {"fov_deg", number, optional, "vertical field of view, degrees"}}},
        {"play",
         "runs the scene's animations",
         "`{}`",
         {{"speed", number, optional, "seconds of animation per second; default 1"}}},
        {"pause", "pauses the scene's animations", "`{}`", {}},
        {"seek", "sets the time of the scene's animations", "`{}`", {{"time_s", number, required, "time, s"}}},
        {"screenshot",
         "saves the first frame that includes the effects of all earlier requests",
         "`{\"file\": ..., \"frame\": ...}`, once the file is written",
         {{"file", text, required, ".png: the picture as shown; .exr: all layers"},
          {"view", integer, optional,
           "index of the view to save, from 0; default: .png saves what is shown, .exr saves view 0"},
          {"converged", boolean, optional, "wait until the picture has its final 4096 paths per pixel"}}},
        {"key",
         "simulates a key press",
         "`{\"frame\": ..., \"after_ms\": ..., \"reprojected\": ...}`, once a frame with its effect is shown",
         {{"key", text, required, "e.g. `w`, `F1`, `escape`"},
          {"action", text, optional, "default `tap`", "tap press release"}}},
        {"pick",
         "returns what is visible at a pixel",
         "`{\"object\": name or null, \"material\": ..., \"position\": point, \"distance_m\": ...}`",
         {{"x_px", number, required, "from the left edge of the first view"},
          {"y_px", number, required, "from its top edge"},
          {"select", boolean, optional, "also select the object, as a click does"}}},
        {"session",
         "returns the state of a running experiment (`study run`), or controls it",
         "`{\"doing\": ..., \"trials_done\": ..., ...}`",
         {{"action", ArgumentType::text, Presence::required, "what to do", "status pause go_on skip abort note"},
          {"text", ArgumentType::text, Presence::optional, "text of the note"}}},
        {"quit", "closes the program cleanly", "`{}`", {}},
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
