#pragma once
// How the level of the varied setting is chosen from trial to trial.

#include "study/script/script_error.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace study {

/// The scale on which a level changes in equal steps. Steps and thresholds are in its units: levels, octaves,
/// decades, decibels (20 log10 of the level).
enum class Scale { linear, log2, log10, db };
double to_scale(Scale scale, double level);
double from_scale(Scale scale, double value);

enum class Method { constant, staircase, questplus, adjustment };
std::optional<Method> method_of(std::string_view name);
std::string_view name_of(Method method);

/// A procedure ends when either number is reached; 0 = no such limit.
struct Stop {
    int trials = 0;    ///< key `trials` or `max_trials`
    int reversals = 0; ///< of a staircase
};

/// The psychometric function that QUEST+ fits.
enum class Psychometric { weibull, normal, logistic };

struct Procedure {
    std::string name;
    Method method = Method::constant;
    Place place;
    /// constant: the levels, each `trials_per_level` times. adjustment: the start level of each trial.
    std::vector<double> levels;
    int trials_per_level = 1;

    // staircase. Transformed (Levitt 1971): `up` wrong answers make it easier by a step, `down` correct ones in a
    // row make it harder. Weighted (Kaernbach 1991), if `target` is given: up = down = 1, and the step to the
    // easier side is target / (1 - target) times the step to the harder one.
    int up = 1, down = 1;
    std::optional<double> target;
    double start = 0;
    std::vector<double> steps; ///< in units of the scale; each reversal moves to the next one, the last one stays

    // questplus (Watson 2017): grids of the prior. threshold in levels, slope of the function on the scale.
    Psychometric psychometric = Psychometric::weibull;
    std::vector<double> threshold, slope, guess, lapse;
    std::vector<double> stimuli; ///< levels that it may present

    Stop stop;
};

/// Number of trials of one run; the maximum for an adaptive procedure.
int planned_trials(Procedure const& procedure);
bool is_adaptive(Procedure const& procedure);
/// Proportion correct to which a staircase converges: for a transformed one the root of
/// P(next change is harder) = 1/2, found numerically; for a weighted one its target.
double settles_at(Procedure const& staircase);

} // namespace study
