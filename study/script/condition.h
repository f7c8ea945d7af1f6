#pragma once
// A stimulus: levels of all factors, and the renderer settings that result from them.

#include "study/script/script.h"

namespace study {

/// One picture or sequence to show.
struct Stimulus {
    std::vector<int> levels;       ///< by factor
    bool is_varied = false;        ///< it has the setting that `compare` varies
    std::optional<double> level;   ///< of that setting; none = the procedure chooses it at the trial
    std::vector<double> also = {}; ///< levels of the further settings of `compare`; empty = their usual ones
    bool operator==(Stimulus const&) const = default;
};

double easiest(Compare const& compare);
/// Levels of a factor that the block uses, after its `only`.
std::vector<int> crossed_levels(Script const& script, Block const& block, int factor);
/// Replaces the value of a key, or adds it at the end.
/// Without the prefix "gi.", which settings may have.
std::string plain_key(std::string const& key);
void set_setting(Patch& patch, std::string const& key, std::string const& value);
/// All settings of a stimulus: those of defaults and block, those of the factors' levels in the order of the
/// script, then `with` and the level of the varied setting. If a key is set twice, the later value counts.
Patch settings_of(Script const& script, Block const& block, Stimulus const& stimulus);

/// Text of a planned level in tables: the shortest with at most nine significant digits.
std::string level_text(double level);

} // namespace study
