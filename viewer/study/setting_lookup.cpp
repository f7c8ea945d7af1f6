#include "viewer/study/setting_lookup.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/text.h"
#include "gi/methods/registry.h"
#include "gi/scene/load/load.h"
#include "study/script/condition.h"
#include "study/script/written_settings.h"
#include "viewer/engine/scene_edits.h"
#include "viewer/study/physical_setting.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace viewer {
namespace {

using Json = nlohmann::json;

StimulusSetting const* find_own(std::string const& key)
{
    for (StimulusSetting const& s : stimulus_settings())
        if (s.key == key) return &s;
    return nullptr;
}

SettingKey const* find_of_viewer(std::string const& key)
{
    std::string const current = current_key(key);
    for (SettingKey const& k : setting_keys())
        if (k.key == current) return &k;
    return nullptr;
}

std::vector<std::string> known_keys()
{
    std::vector<std::string> known;
    for (StudySetting const& s : study_settings()) known.push_back(s.key);
    for (char const* const kind : {"light", "material", "object", "environment"}) known.emplace_back(kind);
    return known;
}

void check_known(std::string const& key)
{
    if (find_own(key) != nullptr || find_of_viewer(key) != nullptr || is_ar_key(key)) return;
    if (is_scene_edit(key)) {
        find_scene_edit(key);
        return;
    }
    throw gi::InputError("there is no setting '" + key + "'", "the renderer does not know it",
                         gi::suggest(key, known_keys(), "lightwell info --settings has the list"));
}

void check_number(std::string const& key, double value, double low, double high)
{
    if (!(value >= low && value <= high))
        throw gi::InputError(fmt::format("'{}' = {:g}", key, value),
                             fmt::format("it takes numbers from {:g} to {:g}", low, high),
                             "set one in this range");
}

void check_scene(std::string const& scene, std::filesystem::path const& folder)
{
    std::error_code none;
    auto const known = gi::built_in_scenes();
    if (std::filesystem::exists(scene_file(folder, scene), none)) return;
    if (std::find(known.begin(), known.end(), scene) != known.end()) return;
    throw gi::InputError(
        "there is no scene '" + scene + "'",
        "no file of that name is beside the script or in the current folder, nor is it generated",
        gi::suggest(scene, known, fmt::format("name a file, or one of {}", fmt::join(known, ", "))));
}

void check_own(std::string const& key, std::string const& value, std::filesystem::path const& folder)
{
    StimulusSetting const& own = *find_own(key);
    if (key == "scene") check_scene(value, folder);
    if (key == "camera" && value.starts_with("path:")) path_of(value.substr(5));
    if (key == "visibility") visibility_method(value);
    if (key == "frames" && value != "exact" && value != "shown")
        throw gi::InputError("frames: " + value, "there is no such choice", "write exact or shown");
    if (key == "view" && value != "window" && value != "openxr")
        throw gi::InputError("view: " + value, "there is no such display", "choose window or openxr");
    if (is_physical_setting(key)) {
        PhysicalStimulus stimulus;
        return set_physical(stimulus, key, value);
    }
    if (!own.takes_numbers()) return;
    auto const number = gi::parse_finite(value);
    if (!number) throw gi::InputError(key + ": " + value, "a number is needed here", "write 1 or 0.5");
    check_number(key, *number, own.low, own.high);
}

void check_of_viewer(std::string const& key, Json const& value, MadeFor made)
{
    if (current_key(key) == "device")
        throw gi::InputError("device: " + value.dump(),
                             "stimuli are rendered on the CPU, so that they are equal at all sites",
                             "leave it out");
    Settings settings = first_settings(made);
    if (made == MadeFor::this_version) check_offered(settings, key);
    set(settings, current({key, value}, made));
}

} // namespace

std::string visibility_method(std::string const& word)
{
    for (gi::Method const& m : gi::methods())
        if (!m.visibility.empty() && m.visibility == word) return std::string(m.name);
    throw gi::InputError("visibility: " + word, "there is no such approximation",
                         gi::suggest(word, visibility_words()));
}

StimulusPath path_of(std::string const& name)
{
    if (name == "orbit") return StimulusPath::orbit;
    throw gi::InputError("camera: path:" + name, "there is no such path", "write path:orbit");
}

namespace {

bool takes_whole_numbers(std::string const& key)
{
    SettingKey const* const k = find_of_viewer(key);
    return k != nullptr && k->type == gi::OptionType::whole_number;
}

/// Throws if a script writes a fraction that would be rounded. Procedures may choose such levels.
void check_whole(std::string const& key, std::string const& value)
{
    auto const number = gi::parse_finite(value);
    if (number && *number != std::floor(*number) && takes_whole_numbers(key))
        throw gi::InputError(fmt::format("'{}' = {}", key, value), "it takes whole numbers",
                             fmt::format("write {:g} or {:g}", std::floor(*number), std::ceil(*number)));
}

/// Throws if two levels are the same number after rounding.
void check_rounded_levels(std::string const& key, std::vector<double> const& levels)
{
    if (!takes_whole_numbers(key)) return;
    for (std::size_t i = 1; i < levels.size(); ++i)
        if (levels[i] != levels[i - 1] && std::llround(levels[i]) == std::llround(levels[i - 1]))
            throw gi::InputError(
                fmt::format("'{}' with the levels {:g} and {:g}", key, levels[i - 1], levels[i]),
                fmt::format("it takes whole numbers, and both are rounded to {}", std::llround(levels[i])),
                "choose levels that differ by 1 or more");
}

} // namespace

Json setting_value(std::string const& key, std::string const& text)
{
    Json value = Json::parse(text, nullptr, false);
    if (value.is_discarded()) value = text;
    return takes_whole_numbers(key) && value.is_number_float() ? Json(std::llround(value.get<double>())) : value;
}

std::string scene_file(std::filesystem::path const& folder, std::string const& scene)
{
    std::error_code none;
    std::filesystem::path const beside = folder / scene;
    return std::filesystem::exists(beside, none) ? beside.string() : scene;
}

bool is_ar_key(std::string const& key) { return key == "ar" || key.starts_with("ar."); }

MadeFor made_for(study::Script const& script)
{
    return script.schema == 1 ? MadeFor::version_0_1 : MadeFor::this_version;
}

void look_up_setting(std::string const& written, std::string const& value, std::filesystem::path const& folder,
                     MadeFor made)
{
    std::string const key = study::plain_key(written);
    check_known(key);
    if (is_ar_key(key)) return;
    if (find_own(key) != nullptr) return check_own(key, value, folder);
    Json const json = setting_value(key, value);
    if (is_scene_edit(key)) return check_scene_edit({key, json});
    check_of_viewer(key, json, made);
}

std::string look_up_varied(std::string const& written)
{
    std::string const key = study::plain_key(written);
    check_known(key);
    std::string takes;
    if (StimulusSetting const* const own = find_own(key))
        takes = own->takes_numbers() ? "" : own->kind == "word" ? "a word" : std::string(own->kind);
    else if (is_scene_edit(key)) {
        SceneEditKey const& edit = find_scene_edit(key);
        if (edit.count > 1 && !edit.or_one) takes = fmt::format("{} numbers", edit.count);
    } else if (SettingKey const* const k = find_of_viewer(key); k != nullptr && !takes_numbers(*k))
        takes = k->type == gi::OptionType::word ? "a word" : "yes or no";
    if (takes.empty()) return key;
    throw gi::InputError("'" + key + "' cannot be varied by a procedure", "it takes " + takes + ", no number",
                         "compare levels of a factor, or vary a number: lightwell info --settings has them");
}

void look_up_varied(std::string const& written, double low, double high, MadeFor made)
{
    std::string const key = look_up_varied(written);
    if (is_ar_key(key)) return;
    for (double const end : {low, high})
        if (find_own(key) != nullptr)
            check_own(key, study::level_text(end), {});
        else if (is_scene_edit(key))
            check_scene_edit({key, Json(end)});
        else
            check_of_viewer(key, setting_value(key, study::level_text(end)), made);
}

std::set<std::pair<std::string, std::string>> find_wrong_settings(study::Script const& script,
                                                                  std::string const& text,
                                                                  std::filesystem::path const& folder,
                                                                  study::Mistakes& m)
{
    std::set<std::pair<std::string, std::string>> wrong;
    for (study::WrittenSetting const& s : study::written_settings(script, text)) {
        study::Place where = s.value_place;
        try {
            where = s.key_place;
            check_known(study::plain_key(s.key));
            where = s.value_place;
            if (s.varied) {
                look_up_varied(s.key, s.varied->first, s.varied->second, made_for(script));
                check_rounded_levels(study::plain_key(s.key), s.levels);
            } else if (!s.block.empty()) {
                look_up_varied(s.key);
            } else {
                check_whole(study::plain_key(s.key), s.value);
                look_up_setting(s.key, s.value, folder, made_for(script));
            }
        } catch (gi::InputError const& e) {
            wrong.emplace(s.key, s.value);
            m.add(study::ScriptError(script.file, where, e.problem(), e.why(), e.suggestion()));
        }
    }
    return wrong;
}

LoadedScript load_looked_up(std::string const& file, bool any_settings)
{
    ScriptToCheck read = load_script_to_check(file);
    if (read.is_whole && !any_settings)
        find_wrong_settings(read.loaded.script, read.loaded.text, read.loaded.folder, read.mistakes);
    throw_first(read.mistakes);
    return std::move(read.loaded);
}

void throw_first(study::Mistakes const& mistakes)
{
    if (mistakes.empty()) return;
    auto const all = mistakes.in_order();
    study::ScriptError const& first = all.front();
    if (all.size() == 1) throw first;
    throw gi::InputError(
        first.where(), first.problem(), first.why(),
        fmt::format("{} (and {} more: lightwell study check lists all)", first.suggestion(), all.size() - 1));
}

} // namespace viewer
