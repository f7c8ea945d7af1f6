#include "viewer/experiment/stimuli/stimulus_settings.h"

#include "gi/core/error.h"
#include "gi/core/sha256.h"
#include "gi/core/text.h"
#include "gi/filter/filter_names.h"
#include "viewer/engine/scene_edits.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace viewer {
namespace {

using Json = nlohmann::json;

/// Without paths, so that the same session in another folder counts as equal.
Json text_of(ArStimulus const& s)
{
    return {{"session", s.text},
            {"frame", s.frame ? Json(*s.frame) : Json()},
            {"from_s", s.from_s},
            {"show", int(s.show)},
            {"poses", s.poses.filename().string()}};
}

/// The picture is the camera's, rendered as its session specifies.
void check_beside_ar(study::Patch const& patch, std::string const& camera)
{
    for (auto const& [key, value] : patch) {
        if (is_ar_setting(key) || is_physical_setting(key) || (key == "view" && value == "window")) continue;
        throw ArSettingError(key, value, fmt::format("{}: {} of a stimulus with an AR session", key, value),
                             "the session sets viewpoint and rendering, and it is shown in a window",
                             "leave it out, or write a setting of the session: ar.render.paths");
    }
    if (!camera.empty())
        throw gi::InputError("camera: " + camera + " of a stimulus with an AR session",
                             "it has the viewpoint of the session's camera", "leave it out");
}

std::string text_of(StimulusSettings const& s)
{
    Json all = all_settings(s.settings);
    all.erase("device"); // it is always cpu
    if (s.ar) all["ar"] = text_of(*s.ar);
    Json edits = Json::array();
    for (Change const& c : s.edits) edits.push_back({c.key, c.value});
    Json text{{"scene", s.scene},    {"camera", s.camera},
              {"path", int(s.path)}, {"view", s.view ? int(*s.view) : -1},
              {"settings", all},     {"edits", edits}};
    if (s.raise_m != 0) text["raise_m"] = s.raise_m;
    if (s.fov_deg) text["fov_deg"] = *s.fov_deg;
    if (s.physical.any()) text["physical"] = text_of(s.physical);
    return text.dump();
}

} // namespace

std::string name_of(StimulusSettings const& s) { return s.ar ? s.ar->session.string() : s.scene; }

StimulusSettings stimulus_settings(study::Script const& script, study::Block const& block,
                                   study::Stimulus const& stimulus)
{
    return stimulus_settings(settings_of(script, block, stimulus), block.camera,
                             std::filesystem::path(script.file).parent_path(), made_for(script));
}

StimulusSettings stimulus_settings(study::Patch const& patch, std::string const& camera,
                                   std::filesystem::path const& folder, MadeFor made)
{
    StimulusSettings s;
    s.settings = first_settings(made);
    s.settings.panel = false;
    s.settings.refine = false;
    if (std::any_of(patch.begin(), patch.end(), [](auto const& one) { return is_ar_setting(one.first); })) {
        study::Patch of_session;
        for (auto const& one : patch)
            if (is_physical_setting(one.first))
                set_physical(s.physical, one.first, one.second);
            else
                of_session.push_back(one);
        s.ar = ar_stimulus(of_session, folder);
        check_beside_ar(patch, camera);
        s.view = StimulusViewer::window;
        s.sha256 = gi::sha256(text_of(s));
        return s;
    }
    constexpr std::string_view kPath = "path:", kGi = "gi.";
    auto const see_from = [&](std::string const& name) {
        if (name.starts_with(kPath))
            s.path = path_of(name.substr(kPath.size()));
        else
            s.camera = name;
    };
    see_from(camera);
    for (auto const& [written, text] : patch) {
        if (written != "scene" && written != "gi.scene")
            look_up_setting(written, text, folder, made); // loading finds it
        std::string const key = written.starts_with(kGi) ? written.substr(kGi.size()) : written;
        if (key == "scene")
            s.scene = text;
        else if (key == "camera")
            see_from(text);
        else if (key == "camera.raise")
            s.raise_m = gi::parse_finite(text).value_or(0);
        else if (key == "camera.fov")
            s.fov_deg = gi::parse_finite(text);
        else if (key == "visibility")
            set(s.settings, {"method", visibility_method(text)});
        else if (key == "frames")
            s.settings.draw_surfaces = text == "shown";
        else if (key == "view")
            s.view = text == "openxr" ? StimulusViewer::headset : StimulusViewer::window;
        else if (is_physical_setting(key))
            set_physical(s.physical, key, text);
        else if (is_scene_edit(key))
            s.edits.push_back({key, setting_value(key, text)});
        else
            set(s.settings, current({key, setting_value(key, text)}, made));
    }
    gi::check_filter(denoise_settings(s.settings, 0));
    if (s.scene.empty())
        throw gi::InputError("a stimulus without a scene", "there would be nothing to show",
                             "give a factor or defaults.settings the setting `scene`, or `ar` for an AR session");
    s.sha256 = gi::sha256(text_of(s)); // with the scene's name as written, independent of the script's folder
    s.scene = scene_file(folder, s.scene);
    return s;
}

study::Block plain_block(study::Script const& script)
{
    study::Block block;
    block.name = "free_walk";
    block.settings = script.defaults.settings;
    block.camera = script.defaults.camera;
    return block;
}

} // namespace viewer
