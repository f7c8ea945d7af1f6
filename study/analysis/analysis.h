#pragma once
// Results of an experiment with their uncertainty. Intervals are 95 % confidence intervals unless the settings
// differ. If there are too few data for a number it is NaN, and `refused` states why.

#include "study/stats/agreement.h"
#include "study/stats/binomial.h"
#include "study/stats/effect_size.h"
#include "study/stats/hierarchical_pairs.h"
#include "study/stats/mixed_anova.h"
#include "study/stats/psychometric_fit.h"
#include "study/stats/sampler.h"
#include "study/tables/dataset.h"

#include <functional>
#include <limits>
#include <map>
#include <span>

namespace study {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct AnalysisSettings {
    std::vector<std::string> exclude{}; ///< ids of excluded participants
    int replicates = 1000;              ///< of bootstraps over observers
    int permutations = 1999;            ///< of tests of effects; 0 = none
    int draws = 700;                    ///< of each of 4 chains of hierarchical models; 0 = no such models
    double confidence = 0.95;
    std::uint64_t seed = 1;
    bool has_outliers = true;               ///< outlier scores of observers of pairs: a scale without each of them
    bool has_deviations = true;             ///< intervals of how much thresholds and d' differ between observers
    bool has_hierarchy = false;             ///< hierarchical models of pairs, too: a second or so for each
    std::optional<double> guess{}, lapse{}; ///< fixed rates of psychometric functions; none = as the task requires
    /// Called often while a hierarchical model is sampled, with its name and the share that is done.
    /// May be called from several threads, but never by two at once.
    std::function<void(std::string const&, double)> progress{};
};

/// A number with its interval; NaN = unknown.
struct Uncertain {
    double value = kUnknown;
    Interval interval{kUnknown, kUnknown};
    int n = 0;                ///< observers
    bool is_constant = false; ///< those of all observers are equal but for rounding: there is no interval
};

/// Data of a participant excluded from the analysis, or included although questionable.
struct Exclusion {
    std::string participant, what, why;
    int trials = 0;
};

struct ObserverSummary {
    std::string participant;
    bool is_excluded = false, is_complete = true, is_simulated = false;
    int sessions = 0, counted = 0, practice = 0, invalid = 0, superseded = 0, unanswered = 0;
    int catches = 0, catches_right = 0;
    int choices = 0, chose_first = 0; ///< main trials whose answers are first or second
    double bias_p = kUnknown;         ///< exact test of "first as often as second"
    int triads = 0, most_triads = 0;  ///< circular triads over all cells with all pairs, and their maximum
    double zeta = kUnknown;
    std::map<std::string, double> outlier_score; ///< by block of pairs
    double reaction_median_ms = kUnknown;
};

struct ScaledItem {
    std::string name;
    Uncertain score;
    Uncertain render_ms; ///< mean rendering time per frame, over observers; n = observers
};
struct ItemDifference {
    int a = 0, b = 0; ///< items; value = score of a - score of b
    Uncertain value;
    double p = kUnknown, p_holm = kUnknown; ///< for "no difference"; Holm 1979 over all pairs of the group
};
/// The cheapest item that does not differ significantly from the reference or the best item.
struct Cheapest {
    int item = -1, against = -1;
    bool is_reference = false; ///< `against` is the reference; else the best judged item
    Uncertain difference;      ///< between the item and `against`
    double p_holm = kUnknown;
};
struct NamedValue {
    std::string name;
    double value = kUnknown;
};

/// Scores of items on one scale, from the trials that share a level ("scene=arches") or from all.
struct ScaleResult {
    std::string group, unit; ///< unit: JOD, rating, ln(magnitude), level, utility
    int observers = 0, observations = 0;
    std::vector<ScaledItem> items;
    std::vector<ItemDifference> differences; ///< a < b
    std::vector<std::vector<double>> wins;   ///< for pairs: how often the row was chosen over the column
    std::vector<std::vector<int>> spread;    ///< for ratings: how often each value was given, by item
    std::vector<NamedValue> facts;           ///< goodness of fit, agreement, order effect
    std::optional<Cheapest> cheapest;
    std::optional<HierarchicalScale> hierarchy; ///< of pairs, if the settings ask for it
    std::vector<std::string> notes;
    std::string refused; ///< why there is no scale
};

struct AgreementResult {
    std::string cell;
    int observers = 0, left_out = 0; ///< left out: observers who did not judge every pair
    std::optional<KendallU> kendall;
    std::optional<EqualityTest> equality;
    std::string refused;
};

/// Estimate of one threshold by one method, at one proportion correct.
struct ThresholdEstimate {
    std::string method; ///< mean of reversals, likelihood, QUEST+ posterior
    double proportion = kUnknown;
    Uncertain level;
    std::string note;
    std::string doubt{}; ///< what in the note is counted over runs, without numbers of this one; empty = nothing
};
/// Posterior of one parameter of QUEST+ with several settings or further parameters.
struct ParameterEstimate {
    std::string name;
    double mean = kUnknown, sd = kUnknown;
    std::string note{};
};
struct ThresholdRun {
    std::string participant, procedure, cell;
    int run = 1;
    std::vector<double> levels;
    std::vector<int> correct;
    std::vector<int> reversals; ///< trials, from 0
    std::vector<ThresholdEstimate> estimates;
    std::vector<ParameterEstimate> parameters{};
    std::string note{};    ///< why there are no parameters although the procedure has them
    bool has_order = true; ///< false: the order of its trials is unknown
};
/// Mean threshold of the population by one procedure and method, on the scale of levels.
struct ThresholdSummary {
    std::string procedure, cell, method;
    double proportion = kUnknown;
    Uncertain level;
    double deviation = kUnknown; ///< of thresholds between observers, in units of the scale
    Interval deviation_interval{kUnknown, kUnknown}; ///< an end that the answers leave open is infinite
    std::string note;
};
/// The psychometric function of the average observer in one condition, from all procedures.
struct CurveResult {
    std::string cell;
    std::string function; ///< its name, or the formula
    int observers = 0;
    std::vector<LevelCount> counts; ///< of all observers
    PsychometricShape shape;
    PsychometricParameters parameters; ///< scale and lapse rate are common to the observers
    double eta = 0;                    ///< overdispersion
    Uncertain threshold;               ///< mean over the population of the level at `proportion`
    double deviation = kUnknown;       ///< of these levels between observers, in units of the scale
    Interval deviation_interval{kUnknown, kUnknown}; ///< as ThresholdSummary
    /// A decade in units of the scale: log10 1, log2 3.32, db 20; 1 where levels are linear.
    double scale_unit = 1;
    double proportion = kUnknown;
    PsychometricFit pooled; ///< one function through all trials, for its deviance
    std::string note, refused;
};

/// Correct answers of one condition, for tasks that have them.
struct DetectionResult {
    std::string condition;
    int observers = 0;
    double correct = 0, trials = 0;
    Interval interval;           ///< Wilson, all trials pooled
    double dprime = kUnknown;    ///< all trials pooled, log-linear correction; negative below chance
    Uncertain observer_dprime;   ///< mean of the population
    double deviation = kUnknown; ///< of d' between observers
    Interval deviation_interval{kUnknown, kUnknown};
    double p = kUnknown;         ///< of "the mean is 0"
    double criterion = kUnknown; ///< mean; unknown for oddity
    std::string model, note;
};

/// A hierarchical Bayesian model of one parameter of the observers in one condition.
struct HierarchicalResult {
    std::string condition, parameter; ///< parameter: "d'", "threshold at 75 %"
    int observers = 0;
    Uncertain mean, deviation; ///< of the population; deviation of thresholds in units of the scale
    std::vector<std::string> participants;
    std::vector<Uncertain> each;               ///< of the participants: shrunken towards the mean
    double scale = kUnknown, lapse = kUnknown; ///< of psychometric functions, the population's
    SamplerReport report;
    std::string note, refused;
};

struct BlockResult {
    std::string name, task, prompt;
    bool is_log = false; ///< levels are on a logarithmic scale
    std::vector<ScaleResult> scales;
    std::vector<AgreementResult> agreement;
    std::vector<ThresholdRun> runs;
    std::vector<ThresholdSummary> thresholds;
    std::vector<CurveResult> curves;
    std::vector<DetectionResult> detections;
    std::vector<HierarchicalResult> hierarchical;
};

struct QuestionnaireResult {
    std::string questionnaire, score, when; ///< when: "time 1", "display=hmd"
    Uncertain mean;
    double deviation = kUnknown;
};
struct QuestionnaireChange {
    std::string questionnaire, score;
    int from = 1, to = 2; ///< times
    Uncertain change;
    double p = kUnknown;
};

struct CalibrationResult {
    std::string participant;
    int part = 1;
    CalibrationDone done;
};
struct ReactionResult {
    std::string block;
    std::vector<double> ms; ///< of counted trials
};
struct TimingResult {
    std::vector<CalibrationResult> calibrations;
    std::map<std::string, int> onset_methods;                     ///< stimuli by method
    std::vector<double> uncertainty_ms, frame_ms, bookkeeping_ms; ///< by stimulus, stimulus, trial
    long frames_planned = 0, frames_shown = 0, frames_dropped = 0;
    int stimuli = 0, stimuli_with_drops = 0;
    std::vector<ReactionResult> reactions;
};

/// Transitions between neighbouring trials, summed over participants.
struct TransitionResult {
    std::string block, subject;
    std::vector<std::string> names;
    std::vector<int> counts; ///< names.size() squared, [from][to]
    double switched = 0, by_chance = 0;
};

/// One effect of an analysis of variance of observers' means, with groups of participants and conditions.
struct EffectResult {
    std::string block, measure, effect; ///< "display x scene"
    int observers = 0;                  ///< with all cells
    AnovaEffect test;
    double p_holm = kUnknown; ///< of p_gg, over the effects of one measure
};
/// Difference of two groups of participants (Welch 1947).
struct GroupDifference {
    std::string block, measure, cell; ///< cell: "mean" over all conditions, or one of them
    std::string a, b;                 ///< "display=hmd"
    WelchTest test;
    double p_holm = kUnknown; ///< over the comparisons of one measure
};
/// How a factor that varies enters the tests of effects.
struct FactorUse {
    std::string name;
    bool is_between =
        false; ///< it tells groups of participants apart; else each of them is compared with himself or herself
    std::vector<std::string> levels;
    std::vector<int> participants; ///< with counted trials at each level
    int with_several = 0;          ///< participants with more than one level
};
/// Why a measure was not tested, or with fewer observers.
struct EffectNote {
    std::string block, measure, text;
};

struct Analysis {
    std::string experiment, title;
    std::string version, git_hash; ///< of the program; empty = unknown
    std::vector<InputFile> inputs; ///< script, journals, tables
    AnalysisSettings settings;
    int participants = 0, sessions = 0, complete = 0, simulated = 0, planned = 0;
    int other_plans = 0;   ///< sessions whose recorded plan is not the one that this version makes
    int assumed_plans = 0; ///< sessions whose recorded plan is lost
    std::vector<Exclusion> exclusions;
    std::vector<ObserverSummary> observers;
    std::vector<BlockResult> blocks;
    std::vector<QuestionnaireResult> questionnaires;
    std::vector<QuestionnaireChange> changes;
    std::vector<FactorUse> factors;
    std::vector<EffectResult> effects;
    std::vector<GroupDifference> group_differences;
    std::vector<EffectNote> effect_notes;
    TimingResult timing;
    std::vector<TransitionResult> transitions;
    std::vector<std::string> cautions; ///< warnings about the validity of the results
};

/// @throws ScriptError as trial_rows and answered_questionnaires, and if a participant to exclude does not exist
Analysis analyze(Script const& script, std::vector<RecordedSession> const& sessions,
                 AnalysisSettings const& settings = {});
/// The remarks of the dataset, such as rows left out, are cautions of the results, too.
Analysis analyze(Dataset const& records, AnalysisSettings const& settings);
/// Scales, thresholds and effects of one block, without timing, order and questionnaires: for simulations.
Analysis analyze_one_block(Script const& script, std::span<RecordedSession const> sessions, int block,
                           AnalysisSettings const& settings);

} // namespace study
