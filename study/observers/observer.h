#pragma once
// Who answers in a simulated session. Qualities and their differences are in JOD: of two stimuli that are 1 JOD
// apart the better one is chosen in 75 % of the trials (Perez-Ortiz & Mantiuk 2017, arXiv:1712.03686), so a
// percept is the quality with normal noise of standard deviation 1.4826 / sqrt(2) (Thurstone's case V).

#include "study/script/script.h"
#include "study/stats/random.h"

namespace study {

/// How well the level of a setting is seen: P(right) = guess + (1 - guess - lapse) F, where F is the Weibull
/// function 1 - exp(-(level / threshold)^slope) on logarithmic scales, on the linear one Phi((level - threshold) /
/// slope); with signs turned round where higher levels are harder. guess is that of the task.
struct VariedModel {
    std::string setting;
    Scale scale = Scale::linear;
    double low = 0, high = 0; ///< of the setting
    double threshold = 0, slope = 1;
    double between_sd = 0; ///< of participants' thresholds, in units of the scale
};

/// All participants.
struct ObserverModel {
    std::vector<std::vector<double>> quality;   ///< by factor and level, JOD; they add up; empty = does not matter
    std::vector<std::vector<double>> render_ms; ///< by factor and level; they add up; empty = nothing
    std::vector<VariedModel> varied;
    double between_sd = 0.2; ///< of participants' qualities of a level, JOD
    double noise = 1;        ///< times the noise of a percept
    double lapse = 0.02;     ///< share of answers that are given blindly
    double side_bias = 0.1;  ///< JOD in favour of what comes first
    double tie_width = 0.4;  ///< JOD; nearer ones are tied where that is an answer
    double false_alarms =
        0.1; ///< of yes_no and same_different where a setting is varied and there is nothing to find
    double rating_best = 0.8;                    ///< where on the scale quality 0 is, as a share of it
    double rating_span = 5;                      ///< JOD from one end of the scale to the other
    double rating_sd = 0.08;                     ///< of participants' use of the scale, as a share of it
    double reaction_ms = 800, reaction_sd = 0.3; ///< median; standard deviation of the natural logarithm
    double items_mean = 0.3, items_sd = 0.2;     ///< answers of questionnaires as shares of their range
    double items_missing = 0;
    double dropped = 0.01, timeout = 0;  ///< shares of trials
    double hz = 60, period_sd_ms = 0.02; ///< of the display
};

/// One participant.
struct Observer {
    ObserverModel model; ///< with this participant's qualities and thresholds
    double rating_shift = 0;
    std::uint64_t seed = 0;

    /// The random numbers of one purpose, whatever was asked before.
    Random random(std::uint64_t purpose) const;
    double quality(std::vector<int> const& levels) const;
    double render_ms(std::vector<int> const& levels) const;
    VariedModel const& varied(std::string const& setting) const;
};

/// What is assumed where nothing is said: of factors that are paired, compared or ranked (where none is, of those
/// that ratings cross) the reference's level, or the first one, has quality 0 and each further one 0.5 less;
/// thresholds lie in the middle of their range.
ObserverModel usual_observers(Script const& script);
/// The same with what a YAML text changes. @param name of the text in messages @throws ScriptError
ObserverModel read_observers(std::string const& text, std::string const& name, Script const& script);

Observer draw_observer(ObserverModel const& model, std::uint64_t seed, int participant);

/// JSON: the model and the qualities and thresholds of every participant of the script.
std::string truth_text(Script const& script, ObserverModel const& model, std::uint64_t seed);

} // namespace study
