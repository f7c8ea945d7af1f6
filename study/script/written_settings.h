#pragma once
// The settings of stimuli as a script writes them, with their places:
// to look each up in a renderer, which `study` does not know.

#include "study/script/script.h"

#include <optional>

namespace study {

struct WrittenSetting {
    std::string key, value; ///< value: empty if varied
    Place key_place, value_place;
    std::string block;                               ///< if a procedure of it varies the setting
    std::optional<std::pair<double, double>> varied; ///< lowest and highest level presented; none = unknown
    std::vector<double> levels;                      ///< those that procedures list, rising
};

/// In the order of the script: `settings`, `camera` (as a setting of that name), levels of factors, `with`,
/// `vary`. What cannot be read is left out.
/// @param text  of the script
std::vector<WrittenSetting> written_settings(Script const& script, std::string const& text);

/// The lowest and the highest level of the varied setting that trials of the block may have.
std::pair<double, double> presented_ends(Block const& block);

} // namespace study
