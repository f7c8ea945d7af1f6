#pragma once
// The parts of parse_script: each reads one kind of mapping. Those that name others need them read before.

#include "study/script/keys.h"
#include "study/script/script.h"

namespace study {

Patch read_patch(gi::Yaml const& y);
std::vector<Factor> read_factors(gi::Yaml const& y);
/// Names to indices; an unknown one is an error with the nearest name.
int read_factor(gi::Yaml const& name, Script const& s);
int read_level(gi::Yaml const& name, Script const& s, int factor);
int read_questionnaire_name(gi::Yaml const& name, Script const& s);
/// {factor: level, ...}
Choice read_choice(gi::Yaml const& y, Script const& s);
/// Of {factor: F, omit: [levels]}: the levels that remain, at least `least`.
std::vector<int> read_levels_of(gi::Yaml const& y, Script const& s, int factor, std::size_t least);

/// Changes what the mapping has. @param y defaults or a block
void read_trial_timing(gi::Yaml const& y, TrialTiming& timing);
RatingScale read_scale(gi::Yaml const& y);
std::vector<Questionnaire> read_questionnaires(gi::Yaml const& y);
/// A number, a list, or "a..b/n": n from a to b, even on the scale. Rising, each within [low, high].
std::vector<double> read_grid(gi::Yaml const& y, Scale scale, double low, double high);
Procedure read_procedure(gi::Yaml const& y, Compare const& compare, Task task);
Constraint read_constraint(gi::Yaml const& y, Script const& s);
Block read_block(gi::Yaml const& name, gi::Yaml const& y, Script const& s);
std::vector<SequenceItem> read_sequence(gi::Yaml const& y, Script const& s, int depth = 0);

/// What no single place shows: factors without a level, parts that nothing uses. Throws ScriptError.
void check_design(Script const& script);

} // namespace study
