#pragma once
// The parts of parse_script: each reads one kind of mapping. Parts that refer to others must be read after them.
// What is wrong with a part that others do without is added to the Mistakes, and reading
// goes on; readers throw where it cannot.

#include "study/script/keys.h"
#include "study/script/mistakes.h"
#include "study/script/script.h"

#include <functional>

namespace study {

/// A number where these words are possible too, which are read already.
double read_number_or(gi::Yaml const& y, std::vector<std::string> const& words, double low, double high);
Patch read_patch(gi::Yaml const& y, Mistakes& m);
std::vector<Factor> read_factors(gi::Yaml const& y, Mistakes& m);
/// Convert names to indices; an unknown name is an error that suggests the nearest one.
int read_factor(gi::Yaml const& name, Script const& s);
int read_level(gi::Yaml const& name, Script const& s, int factor);
int read_questionnaire_name(gi::Yaml const& name, Script const& s);
/// {factor: level, ...}
Choice read_choice(gi::Yaml const& y, Script const& s, Mistakes& m);
/// Reads {factor: F, omit: [levels]} and returns the remaining levels, at least `least`.
/// Unknown ones are not omitted.
std::vector<int> read_levels_of(gi::Yaml const& y, Script const& s, int factor, std::size_t least, Mistakes& m);

/// Sets the members that the mapping gives. @param y defaults or a block
void read_trial_timing(gi::Yaml const& y, TrialTiming& timing, Mistakes& m);
/// Sets the rules that the mapping gives; `none` removes one. @param y gaze of defaults or a block
void read_gaze(gi::Yaml const& y, GazeRules& gaze, Mistakes& m);
std::vector<Sound> read_sounds(gi::Yaml const& y, Mistakes& m);
/// A list, or `none`. @param s with its sounds
std::vector<Cue> read_cues(gi::Yaml const& y, Script const& s, Mistakes& m);
RatingScale read_scale(gi::Yaml const& y, Mistakes& m);
std::vector<Questionnaire> read_questionnaires(gi::Yaml const& y, Mistakes& m);
/// Reads a number, a list, or "a..b/n" (n values from a to b, evenly spaced on the scale). Values must rise and
/// lie within [low, high].
std::vector<double> read_grid(gi::Yaml const& y, Scale scale, double low, double high);
Procedure read_procedure(gi::Yaml const& y, Compare const& compare, Task task, Mistakes& m);
/// Throws, or adds to `m`, where it is wrong.
Constraint read_constraint(gi::Yaml const& y, Script const& s, Mistakes& m);
/// Sets is_broken if what is wrong with the block is more than a value.
Block read_block(gi::Yaml const& name, gi::Yaml const& y, Script const& s, Mistakes& m);
std::vector<SequenceItem> read_sequence(gi::Yaml const& y, Script const& s, Mistakes& m, int depth = 0);

/// Checks the script as a whole: factors without a level, parts that nothing uses. Blocks that cannot be planned
/// become broken. Nothing counts as unused that a mistake names or `mentions` says the script mentions elsewhere.
void check_design(Script& script, Mistakes& m, std::function<bool(std::string const&)> const& mentions);

} // namespace study
