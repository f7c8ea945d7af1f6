#include "viewer/study/study_settings.h"

#include "gi/methods/registry.h"
#include "viewer/engine/scene_edits.h"
#include "viewer/study/physical_setting.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {
namespace {

constexpr std::string_view kVisibility = "visibility";
constexpr StimulusSetting kOwn[]{
    {"scene", "word", "a scene file or a generated scene", "", "what is shown"},
    {"camera", "word", "a camera of the scene, path:orbit", "", "where it is seen from, and how the camera moves"},
    {"camera.raise", "number", "-1000 to 1000", "0", "height above the camera's own place, m", -1000, 1000},
    {"camera.fov", "number", "1 to 170", "", "vertical field of view, degrees", 1, 170},
    {kVisibility, "word", "", "", "method that approximates the visibility of indirect light"},
    {"size", "length", "0.001 to 170 deg, or cm, px; one or width x height", "",
     "of the picture; a number alone is in degrees", 1e-3, 170},
    {"place", "2 lengths", "-80 to 80 deg, or cm, px", "0 0", "of the picture's centre: right, up"},
    {"luminance", "number", "above 0", "", "with which a rendered 1 is shown, cd/m2", 0, kBrightest_cd_m2},
    {"mean_luminance", "number", "above 0", "", "mean of the first picture, cd/m2", 0, kBrightest_cd_m2},
    {"peak_luminance", "number", "above 0", "", "of the first picture, cd/m2", 0, kBrightest_cd_m2},
    {"frames", "word", "exact, shown", "exact",
     "finished pictures alone, or, between them, their surfaces drawn for the newest pose with the light of the "
     "last"},
    {"view", "word", "window, openxr", "window", "display that shows the stimulus"},
    {"ar", "word", "a session file", "", "AR session instead of a scene; ar.KEY are its settings"},
};
/// Settings of viewers that make no sense for stimuli: those of the device, those of people at a panel, and what
/// `frames` says.
constexpr std::string_view kNotOfStimuli[]{"device", "panel", "font_scale", "refine", "draw_surfaces"};

/// What a setting of the viewer allows, for people.
StudySetting of_viewer(SettingKey const& k)
{
    StudySetting s;
    s.key = k.key;
    s.kind = k.type == gi::OptionType::word           ? "word"
             : k.type == gi::OptionType::number       ? "number"
             : k.type == gi::OptionType::whole_number ? "whole number"
                                                      : "yes or no";
    bool const is_number = k.type == gi::OptionType::number || k.type == gi::OptionType::whole_number;
    if (is_number) s.range = fmt::format("{:g} to {:g}", k.low, k.high);
    if (k.type == gi::OptionType::yes_or_no) s.range = "true, false";
    for (std::string const& word : k.words)
        s.range += (s.range.empty() ? "" : ", ") + (word.empty() ? std::string("\"\"") : word);
    s.usual = k.get(Settings{});
    s.meaning = k.meaning;
    s.can_vary = takes_numbers(k);
    return s;
}

StudySetting of_edit(SceneEditKey const& k)
{
    StudySetting s;
    s.key = pattern_of(k);
    s.kind = k.count == 1 ? "number" : fmt::format("{} numbers{}", k.count, k.or_one ? " or one" : "");
    s.range = fmt::format("{:g} to {:g}", k.low, k.high);
    s.meaning = k.meaning;
    s.can_vary = k.count == 1 || k.or_one;
    return s;
}

} // namespace

std::span<StimulusSetting const> stimulus_settings() { return kOwn; }

std::vector<std::string> visibility_words()
{
    std::vector<std::string> words;
    for (gi::Method const& m : gi::methods())
        if (!m.visibility.empty()) words.emplace_back(m.visibility);
    return words;
}

bool takes_numbers(SettingKey const& k)
{
    if (k.type == gi::OptionType::yes_or_no) return false;
    return k.type != gi::OptionType::word || k.takes_other_words;
}

std::vector<StudySetting> study_settings()
{
    std::vector<StudySetting> all;
    for (StimulusSetting const& s : kOwn) {
        std::string range =
            s.key == kVisibility ? fmt::format("{}", fmt::join(visibility_words(), ", ")) : std::string(s.range);
        all.push_back({std::string(s.key), std::string(s.kind), std::move(range), std::string(s.usual),
                       std::string(s.meaning), s.takes_numbers()});
    }
    for (SceneEditKey const& k : scene_edit_keys()) all.push_back(of_edit(k));
    for (SettingKey const& k : setting_keys())
        if (k.is_offered() &&
            std::find(std::begin(kNotOfStimuli), std::end(kNotOfStimuli), k.key) == std::end(kNotOfStimuli))
            all.push_back(of_viewer(k));
    return all;
}

} // namespace viewer
