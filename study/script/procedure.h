#pragma once
// How the level of what is varied is chosen from trial to trial.

#include "study/script/script_error.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace study {

/// In which a level's steps are equal. Steps and thresholds are in its units: levels, octaves, decades, decibels
/// (20 log10 of the level).
enum class Scale { linear, log2, log10, db };
double to_scale(Scale scale, double level);
double from_scale(Scale scale, double value);

enum class Method { constant, staircase, questplus, adjustment };
std::optional<Method> method_of(std::string_view name);
std::string_view name_of(Method method);

/// Ends when one of them is reached, whichever comes first; 0 = does not end it.
struct Stop {
    int trials = 0;    ///< so many trials, also called max_trials
    int reversals = 0; ///< of a staircase
};

/// The psychometric function that QUEST+ fits.
enum class Psychometric { weibull, normal, logistic };

struct Procedure {
    std::string name;
    Method method = Method::constant;
    Place place;
    /// constant: the levels, each `trials_per_level` times. adjustment: where each trial starts.
    std::vector<double> levels;
    int trials_per_level = 1;

    // staircase. Transformed (Levitt 1971): `up` wrong answers make it easier by a step, `down` right ones in a
    // row harder. Weighted (Kaernbach 1991), where `target` is given: up = down = 1, and the step to the easier
    // side is target / (1 - target) times the step to the harder one.
    int up = 1, down = 1;
    std::optional<double> target;
    double start = 0;
    std::vector<double> steps; ///< in units of the scale; the next one after each reversal, the last one stays

    // questplus (Watson 2017): the grids of its prior. threshold in levels, slope of the function on the scale.
    Psychometric psychometric = Psychometric::weibull;
    std::vector<double> threshold, slope, guess, lapse;
    std::vector<double> stimuli; ///< levels that it may ask for

    Stop stop;
};

/// Trials of one run; of an adaptive procedure the most there can be.
int planned_trials(Procedure const& procedure);
bool is_adaptive(Procedure const& procedure);
/// The share of right answers at which a staircase settles: of a transformed one the root of
/// P(next change is harder) = 1/2, found numerically; of a weighted one its target.
double settles_at(Procedure const& staircase);

} // namespace study
