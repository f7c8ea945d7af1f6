#pragma once
// What is shown: levels of all factors, and the renderer's settings that follow from them.

#include "study/script/script.h"

namespace study {

/// One picture or sequence that is shown.
struct Stimulus {
    std::vector<int> levels;     ///< by factor
    bool is_varied = false;      ///< it has what compare varies
    std::optional<double> level; ///< of that; none = the procedure chooses it when the trial comes
    bool operator==(Stimulus const&) const = default;
};

double easiest(Compare const& compare);
/// Levels of a factor that `only` of the block leaves.
std::vector<int> crossed_levels(Script const& script, Block const& block, int factor);
/// Replaces the value of a key, or adds it at the end.
void set_setting(Patch& patch, std::string const& key, std::string const& value);
/// Everything that is to be set for a stimulus: settings of defaults and block, of the factors' levels in the
/// order of the script, then `with` and the level of what is varied. Where a key is set twice the later one
/// counts.
Patch settings_of(Script const& script, Block const& block, Stimulus const& stimulus);

/// The scale of planned levels in tables: as short as nine digits allow.
std::string level_text(double level);

} // namespace study
