#pragma once
// Model observers, which answer in simulated sessions. Qualities and their differences are in JOD: of two stimuli
// that are 1 JOD apart the better one is chosen in 75 % of the trials (Perez-Ortiz & Mantiuk 2017,
// arXiv:1712.03686), so a percept is the quality plus normal noise of standard deviation 1.4826 / sqrt(2)
// (Thurstone's case V).

#include "study/numeric/random.h"
#include "study/script/script.h"

namespace study {

/// How well an observer sees the level of a setting: P(correct) = guess + (1 - guess - lapse) F; signs are
/// reversed if higher levels are harder. guess is that of the task. F is the function that the procedures name; if
/// they name none, the Weibull function on logarithmic scales, and the normal one on the linear one.
struct VariedModel {
    std::string setting;
    Scale scale = Scale::linear;
    double low = 0, high = 0; ///< of the setting
    double threshold = 0, slope = 1;
    double between_sd = 0; ///< standard deviation of participants' thresholds, in units of the scale
    PsychometricChoice function{};
    std::vector<std::pair<std::string, double>> parameters{}; ///< of a formula, besides the usual ones
    std::vector<std::vector<double>> shift{}; ///< by factor and level, of the threshold, in units of the scale
};

/// Quality that a stimulus has only if it has all these levels.
struct QualityInteraction {
    Choice levels;
    double jod = 0;
};

/// The population of participants.
struct ObserverModel {
    std::vector<std::vector<double>> quality;     ///< by factor and level, JOD; factors add up; empty = no effect
    std::vector<QualityInteraction> interactions; ///< added to that
    std::vector<std::vector<double>> render_ms;   ///< by factor and level; factors add up; empty = none
    std::vector<VariedModel> varied;
    double between_sd = 0.2; ///< standard deviation of participants' qualities of a level, JOD
    double noise = 1;        ///< factor on the noise of a percept
    double lapse = 0.02;     ///< proportion of random answers
    double side_bias = 0.1;  ///< JOD in favour of the first stimulus
    double tie_width = 0.4;  ///< JOD; smaller differences are answered as ties, if the task allows them
    /// Rate for yes_no and same_different if a setting is varied and there is nothing to find.
    double false_alarms = 0.1;
    double rating_best = 0.8;                    ///< rating of quality 0, as a fraction of the scale
    double rating_span = 5;                      ///< JOD from one end of the scale to the other
    double rating_sd = 0.08;                     ///< of participants' rating offsets, as a fraction of the scale
    double reaction_ms = 800, reaction_sd = 0.3; ///< median; standard deviation of the natural logarithm
    double items_mean = 0.3, items_sd = 0.2;     ///< answers of questionnaires as fractions of their range
    double items_missing = 0;
    double dropped = 0.01, timeout = 0;  ///< proportions of trials
    double hz = 60, period_sd_ms = 0.02; ///< of the display
};

/// One participant.
struct Observer {
    ObserverModel model; ///< with this participant's qualities and thresholds
    double rating_shift = 0;
    std::uint64_t seed = 0;

    /// Random generator for one purpose, independent of earlier calls.
    Random random(std::uint64_t purpose) const;
    double quality(std::vector<int> const& levels) const;
    /// Threshold of the varied setting for a stimulus with these levels of factors.
    double threshold(VariedModel const& varied, std::vector<int> const& levels) const;
    double render_ms(std::vector<int> const& levels) const;
    VariedModel const& varied(std::string const& setting) const;
};

/// Default model. For factors that are paired, compared or ranked (if there are none, those that ratings cross),
/// the reference's level, or else the first one, has quality 0 and each further one 0.5 less. Thresholds lie in
/// the middle of their range.
ObserverModel usual_observers(Script const& script);
/// Default model with the changes of a YAML text. @param name name of the text in messages @throws ScriptError
ObserverModel read_observers(std::string const& text, std::string const& name, Script const& script);

Observer draw_observer(ObserverModel const& model, std::uint64_t seed, int participant);

/// JSON: the model and the qualities and thresholds of every participant of the script.
std::string truth_text(Script const& script, ObserverModel const& model, std::uint64_t seed);

} // namespace study
