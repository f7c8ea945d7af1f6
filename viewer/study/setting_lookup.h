#pragma once
// Looks up the settings of stimuli that scripts of experiments have, without loading or rendering anything.

#include "viewer/study/study_script.h"
#include "viewer/study/study_settings.h"

#include <set>

namespace viewer {

/// Motion of the camera while a stimulus is shown.
enum class StimulusPath {
    none,
    orbit ///< once around a small horizontal circle with fixed view direction: gives parallax at one place
};

/// The method that `gi.visibility: word` stands for. Throws InputError.
std::string visibility_method(std::string const& word);
/// "orbit" of "path:orbit". Throws InputError.
StimulusPath path_of(std::string const& name);
/// The value as JSON if it is JSON, else the word; a fractional level of a whole-number setting is rounded.
nlohmann::json setting_value(std::string const& key, std::string const& text);
/// The file beside the script, or else the name as it is. @param folder  of the script
std::string scene_file(std::filesystem::path const& folder, std::string const& scene);
bool is_ar_key(std::string const& key); ///< `ar` or `ar.KEY`: the settings of an AR session

/// Throws InputError unless there is such a setting (with the nearest one, if there is) and it takes the value.
/// Settings of AR sessions are not looked up. @param folder  of the script, for scenes
void look_up_setting(std::string const& key, std::string const& value, std::filesystem::path const& folder,
                     MadeFor made_for = MadeFor::this_version);
/// The version that a script was written for.
MadeFor made_for(study::Script const& script);
/// Throws InputError unless a procedure can vary the setting: it takes numbers. @returns key without prefix
std::string look_up_varied(std::string const& key);
/// As look_up_varied(), and it takes all numbers from `low` to `high`.
void look_up_varied(std::string const& key, double low, double high, MadeFor made_for = MadeFor::this_version);

/// Looks all settings of a script up and adds what is wrong, each with its place.
/// @returns keys and values that are wrong, which stimuli cannot have; of varied settings with an empty value
std::set<std::pair<std::string, std::string>> find_wrong_settings(study::Script const& script,
                                                                  std::string const& text,
                                                                  std::filesystem::path const& folder,
                                                                  study::Mistakes& m);
/// Loads a script and, unless it has settings of another presenter, looks them up. Throws as throw_first().
LoadedScript load_looked_up(std::string const& file, bool any_settings);
/// Throws the first mistake and says how many more there are, if there are any.
void throw_first(study::Mistakes const& mistakes);

} // namespace viewer
