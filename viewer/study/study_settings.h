#pragma once
// The settings that stimuli of experiments may have (docs/study/running.md): those of the viewer
// (viewer/engine/settings.h), with or without the prefix "gi.", edits of the scene (viewer/engine/scene_edits.h),
// and the scene, the camera and the display of a stimulus. setting_lookup.h checks the values that scripts give
// them.

#include "viewer/engine/settings.h"

#include <span>
#include <string>
#include <vector>

namespace viewer {

/// A setting of stimuli, for people.
struct StudySetting {
    std::string key, kind;    ///< kind: "number", "whole number", "word", "yes or no", "3 numbers or one"
    std::string range, usual; ///< allowed values; the default, empty = that of the scene
    std::string meaning;      ///< with the unit
    bool can_vary = false;    ///< a procedure can choose its level: it takes a number
};
/// All settings, those of stimuli that viewers do not have first.
std::vector<StudySetting> study_settings();

/// A setting of stimuli that viewers do not have.
struct StimulusSetting {
    std::string_view key, kind, range, usual, meaning;
    double low = 0, high = -1; ///< of a number; empty: it is none

    constexpr bool takes_numbers() const { return high >= low; }
};
std::span<StimulusSetting const> stimulus_settings();

/// The words of the key `visibility`, of the methods that have one.
std::vector<std::string> visibility_words();

/// Words may be numbers too: "16384" or "30%".
bool takes_numbers(SettingKey const& k);

} // namespace viewer
