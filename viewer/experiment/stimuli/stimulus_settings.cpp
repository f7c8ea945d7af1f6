#include "viewer/experiment/stimuli/stimulus_settings.h"

#include "gi/core/error.h"
#include "gi/core/sha256.h"
#include "gi/filter/filter_names.h"
#include "viewer/engine/scene_edits.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace viewer {
namespace {

using Json = nlohmann::json;

/// The words in scripts (`exact`, `imperfect`, `directional_ao`) and their methods.
std::string visibility_method(std::string const& word)
{
    static std::map<std::string, std::string> const kMethods{{"exact", "vpl_exact"},         {"slhb", "vpl_slhb"},
                                                             {"imperfect", "vpl_imperfect"}, {"ao", "vpl_ao"},
                                                             {"directional_ao", "vpl_dao"},  {"none", "vpl_none"}};
    auto const found = kMethods.find(word);
    if (found != kMethods.end()) return found->second;
    std::string known;
    for (auto const& [name, method] : kMethods) known += (known.empty() ? "" : ", ") + name;
    throw gi::InputError("gi.visibility: " + word, "there is no such approximation", "choose one of: " + known);
}

Json json_value_of(std::string const& text)
{
    Json const value = Json::parse(text, nullptr, false);
    return value.is_discarded() ? Json(text) : value;
}

/// Levels chosen by a procedure may be fractional; whole-number settings use the nearest integer.
Json fitting(std::string const& key, Json const& value)
{
    auto const is_whole = [&](SettingKey const& k) {
        return k.key == current_key(key) && k.type == gi::OptionType::whole_number;
    };
    return std::ranges::any_of(setting_keys(), is_whole) && value.is_number_float()
               ? Json(std::llround(value.get<double>()))
               : value;
}

StimulusPath path_of(std::string const& name)
{
    if (name == "orbit") return StimulusPath::orbit;
    throw gi::InputError("camera: path:" + name, "there is no such path", "write path:orbit");
}

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

/// A name that is not a file may be a generated scene.
std::string scene_file(std::filesystem::path const& folder, std::string const& scene)
{
    std::error_code none;
    std::filesystem::path const beside = folder / scene;
    return std::filesystem::exists(beside, none) ? beside.string() : scene;
}

std::string text_of(StimulusSettings const& s)
{
    Json all = all_settings(s.settings);
    all.erase("device"); // it is always cpu
    if (s.ar) all["ar"] = text_of(*s.ar);
    Json edits = Json::array();
    for (Change const& c : s.edits) edits.push_back({c.key, c.value});
    Json whole{{"scene", s.scene},    {"camera", s.camera},
               {"path", int(s.path)}, {"view", s.view ? int(*s.view) : -1},
               {"settings", all},     {"edits", edits}};
    if (s.physical.any()) whole["physical"] = text_of(s.physical);
    return whole.dump();
}

} // namespace

std::string name_of(StimulusSettings const& s) { return s.ar ? s.ar->session.string() : s.scene; }

StimulusSettings stimulus_settings(study::Script const& script, study::Block const& block,
                                   study::Stimulus const& stimulus)
{
    return stimulus_settings(settings_of(script, block, stimulus), block.camera,
                             std::filesystem::path(script.file).parent_path());
}

StimulusSettings stimulus_settings(study::Patch const& patch, std::string const& camera,
                                   std::filesystem::path const& folder)
{
    StimulusSettings s;
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
        std::string const key = written.starts_with(kGi) ? written.substr(kGi.size()) : written;
        if (key == "scene") {
            s.scene = text;
        } else if (key == "camera") {
            see_from(text);
        } else if (key == "visibility") {
            set(s.settings, {"method", visibility_method(text)});
        } else if (key == "view") {
            if (text != "window" && text != "openxr")
                throw gi::InputError("view: " + text, "there is no such display", "choose window or openxr");
            s.view = text == "openxr" ? StimulusViewer::headset : StimulusViewer::window;
        } else if (key == "device") {
            throw gi::InputError("device: " + text,
                                 "stimuli are rendered on the CPU, so that they are equal at all sites",
                                 "leave it out");
        } else if (is_physical_setting(key)) {
            set_physical(s.physical, key, text);
        } else if (is_scene_edit(key)) {
            s.edits.push_back({key, json_value_of(text)});
        } else {
            set(s.settings, {key, fitting(key, json_value_of(text))});
        }
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

void check_physical_of(std::vector<PlannedStimulus> const& stimuli, study::DisplayModel const* model,
                       bool has_own_views)
{
    for (auto const& [s, where] : stimuli) try {
            bool const in_headset = s.view == StimulusViewer::headset;
            if (s.physical.any() && (has_own_views || in_headset))
                throw gi::InputError("a size, place or luminance on walls or in a headset",
                                     "they are those of a picture in a window",
                                     "leave them out, or run in a window");
            check_physical(s.physical, model);
        } catch (gi::InputError const& e) {
            throw gi::InputError(where, e.what(), "see Physical units in docs/study.md");
        }
}

std::vector<PlannedStimulus> stimuli_of(study::Script const& script, study::Plan const& plan)
{
    std::map<std::string, PlannedStimulus> all;
    for (study::PlanStep const& step : plan.steps) {
        bool const walks = step.kind == study::PlanStepKind::free_walk;
        if (step.kind != study::PlanStepKind::trial && !walks) continue;
        study::Block const block = step.block >= 0 ? script.blocks[std::size_t(step.block)] : plain_block(script);
        auto const add = [&](study::Stimulus const& stimulus) {
            std::string const where =
                fmt::format("{}: block {}, {}", script.file, block.name, stimulus_label(script, block, stimulus));
            try {
                StimulusSettings s = stimulus_settings(script, block, stimulus);
                std::string const digits = s.sha256;
                all.emplace(digits, PlannedStimulus{std::move(s), where});
            } catch (gi::InputError const& e) {
                throw gi::InputError(where, e.what(), "docs/viewer.md has a list of all keys");
            }
        };
        std::vector<study::Stimulus> stimuli = step.trial.stimuli;
        if (walks) stimuli = {study::Stimulus{step.levels, false, {}}};
        if (step.trial.reference) stimuli.push_back(*step.trial.reference);
        for (study::Stimulus& stimulus : stimuli) {
            bool const is_open = stimulus.is_varied && !stimulus.level && block.compare;
            if (!is_open) {
                add(stimulus);
                continue;
            }
            for (double const level : {block.compare->low, block.compare->high}) {
                stimulus.level = level;
                add(stimulus);
            }
        }
    }
    std::vector<PlannedStimulus> list;
    for (auto& [digits, s] : all) list.push_back(std::move(s));
    return list;
}

} // namespace viewer
