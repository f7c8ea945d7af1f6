#pragma once
// How the level of the varied setting is chosen from trial to trial.

#include "study/adaptive/formula.h"
#include "study/adaptive/questplus_many.h"
#include "study/script/script_error.h"

#include <memory>
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
std::optional<Scale> scale_of(std::string_view name);
std::string_view name_of(Scale scale);

enum class Method { constant, staircase, questplus, adjustment };
std::optional<Method> method_of(std::string_view name);
std::string_view name_of(Method method);

/// A procedure ends when either number is reached; 0 = no such limit.
struct Stop {
    int trials = 0;    ///< key `trials` or `max_trials`
    int reversals = 0; ///< of a staircase
};

/// The psychometric functions of scripts. weibull and formula are of levels, the others of their scale; the slope
/// is the exponent of weibull, the steepness of logistic, the spread of the others in units of the scale, and
/// whatever it is in a formula.
enum class Psychometric {
    weibull,           ///< 1 - exp(-(x / threshold)^slope)
    normal,            ///< Phi(z), z = (x - threshold) / slope
    logistic,          ///< 1 / (1 + exp(-slope (x - threshold)))
    gumbel,            ///< 1 - exp(-exp(z))
    gumbel_right,      ///< exp(-exp(-z))
    hyperbolic_secant, ///< 2/pi atan(exp(pi z / 2))
    cauchy,            ///< 1/2 + atan(z) / pi
    formula            ///< P(correct) itself, of x, threshold, slope, guess, lapse
};
/// Names of all but formula, in their order.
std::vector<std::string> psychometric_names();

/// A function by name or by formula.
struct PsychometricChoice {
    Psychometric function = Psychometric::normal;
    std::shared_ptr<Formula const> formula{}; ///< of Psychometric::formula

    bool takes_levels() const { return function == Psychometric::weibull || function == Psychometric::formula; }
    std::string name() const; ///< or the text of the formula
    bool operator==(PsychometricChoice const& other) const { return name() == other.name(); }
};

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
    std::vector<double> threshold, slope, guess, lapse;
    std::vector<double> stimuli;       ///< levels that it may present
    std::vector<QuestGrid> also;       ///< levels of further settings that it may present, by name
    std::vector<QuestGrid> parameters; ///< of the formula, besides threshold, slope, guess and lapse
    bool is_many() const { return !also.empty() || !parameters.empty(); }
    bool has_one_point() const; ///< of its prior, so that it cannot learn

    /// The function that QUEST+ assumes and that fits use; none = usual: assumed_function(), fitted_function().
    std::optional<PsychometricChoice> psychometric;

    Stop stop;
};
/// The function that QUEST+ assumes.
PsychometricChoice assumed_function(Procedure const& questplus);
/// The function that is fitted to trials of these procedures, and by which model observers answer: the one that
/// they name, if they agree, else Weibull's on logarithmic scales and the normal one on the linear scale.
PsychometricChoice fitted_function(std::vector<Procedure> const& procedures, Scale scale);

/// Number of trials of one run; the maximum for an adaptive procedure.
int planned_trials(Procedure const& procedure);
bool is_adaptive(Procedure const& procedure);
/// Proportion correct to which a staircase converges: for a transformed one the root of
/// P(next change is harder) = 1/2, found numerically; for a weighted one its target.
double settles_at(Procedure const& staircase);

} // namespace study
