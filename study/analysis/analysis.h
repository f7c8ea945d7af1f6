#pragma once
// What the records of an experiment say, as numbers with their uncertainty. Intervals are of 95 % unless the
// settings say otherwise. Where there are too few data for a number it is missing, and a text says why: NaN and
// `refused`.

#include "study/stats/agreement.h"
#include "study/stats/binomial.h"
#include "study/stats/psychometric.h"
#include "study/tables/recorded_session.h"

#include <limits>
#include <map>

namespace study {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct AnalysisSettings {
    std::vector<std::string> exclude; ///< participants that are left out, by id
    int replicates = 1000;            ///< of bootstraps over observers
    double confidence = 0.95;
    std::uint64_t seed = 1;
};

/// A number with its interval; NaN = unknown.
struct Uncertain {
    double value = kUnknown;
    Interval interval{kUnknown, kUnknown};
    int n = 0; ///< observers
};

/// What was left out of the analysis of a participant, or is in it though it may not be fit.
struct Exclusion {
    std::string participant, what, why;
    int trials = 0;
};

struct ObserverSummary {
    std::string participant;
    bool is_excluded = false, is_complete = true, is_simulated = false;
    int sessions = 0, counted = 0, practice = 0, invalid = 0, superseded = 0, unanswered = 0;
    int catches = 0, catches_right = 0;
    int choices = 0, chose_first = 0; ///< of main trials whose answers are first or second
    double bias_p = kUnknown;         ///< exact test of "first as often as second"
    int triads = 0, most_triads = 0;  ///< circular ones, over all cells whose pairs are complete
    double zeta = kUnknown, triads_p = kUnknown;
    std::map<std::string, double> outlier_score; ///< by block of pairs
    double reaction_median_ms = kUnknown;
};

struct ScaledItem {
    std::string name;
    Uncertain score;
    Uncertain render_ms; ///< mean time to render a frame of it, over observers; n = observers
};
struct ItemDifference {
    int a = 0, b = 0; ///< items; value = score of a - score of b
    Uncertain value;
    double p = kUnknown, p_holm = kUnknown; ///< of "no difference"; Holm 1979 over all pairs of the group
};
/// The cheapest item that does not differ significantly from the best there is to compare with.
struct Cheapest {
    int item = -1, against = -1;
    bool is_reference = false; ///< `against` is the reference; else the best of those judged
    Uncertain difference;      ///< of the item from it
    double p_holm = kUnknown;
};
struct NamedValue {
    std::string name;
    double value = kUnknown;
};

/// Scores of items on one scale, of the trials that share a level ("scene=arches") or of all.
struct ScaleResult {
    std::string group, unit; ///< unit: JOD, rating, ln(magnitude), level, utility
    int observers = 0, observations = 0;
    std::vector<ScaledItem> items;
    std::vector<ItemDifference> differences; ///< a < b
    std::vector<std::vector<double>> wins;   ///< of pairs: how often the row was chosen over the column
    std::vector<std::vector<int>> spread;    ///< of ratings: how often each value was given, by item
    std::vector<NamedValue> facts;           ///< goodness of fit, agreement, order effect
    std::optional<Cheapest> cheapest;
    std::vector<std::string> notes;
    std::string refused; ///< why there is no scale
};

struct AgreementResult {
    std::string cell;
    int observers = 0, left_out = 0; ///< left out: who did not judge every pair
    std::optional<KendallU> kendall;
    std::optional<EqualityTest> equality;
    std::string refused;
};

/// Estimates of one threshold by one method, at one share of correct answers.
struct ThresholdEstimate {
    std::string method; ///< mean of reversals, maximum likelihood, QUEST+ posterior
    double proportion = kUnknown;
    Uncertain level;
    std::string note;
};
struct ThresholdRun {
    std::string participant, procedure, cell;
    int run = 1;
    std::vector<double> levels;
    std::vector<int> correct;
    std::vector<int> reversals; ///< trials, from 0
    std::vector<ThresholdEstimate> estimates;
};
/// Of one procedure and method over observers: geometric on logarithmic scales.
struct ThresholdSummary {
    std::string procedure, cell, method;
    double proportion = kUnknown;
    Uncertain level;
};
struct CurveResult {
    std::string cell;
    int observers = 0;
    std::vector<LevelCount> counts;
    PsychometricFit fit; ///< of all trials together
    Uncertain threshold; ///< the level at `proportion`
    double proportion = kUnknown;
    std::string refused;
};

/// Right answers of one condition in tasks that have them.
struct DetectionResult {
    std::string condition;
    int observers = 0;
    double correct = 0, trials = 0;
    Interval interval;        ///< Wilson, of all trials together
    double dprime = kUnknown; ///< of all trials together, log-linear correction
    Uncertain observer_dprime;
    std::string model;
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

/// How one trial followed another, summed over participants.
struct TransitionResult {
    std::string block, subject;
    std::vector<std::string> names;
    std::vector<int> counts; ///< names.size() squared, [from][to]
    double switched = 0, by_chance = 0;
};

struct Analysis {
    std::string experiment, title;
    AnalysisSettings settings;
    int participants = 0, sessions = 0, complete = 0, simulated = 0, planned = 0;
    std::vector<Exclusion> exclusions;
    std::vector<ObserverSummary> observers;
    std::vector<BlockResult> blocks;
    std::vector<QuestionnaireResult> questionnaires;
    std::vector<QuestionnaireChange> changes;
    TimingResult timing;
    std::vector<TransitionResult> transitions;
    std::vector<std::string> cautions; ///< what a reader has to know before believing any of it
};

/// @throws ScriptError as trial_rows and answered_questionnaires, and for a participant to exclude who is not
/// there
Analysis analyze(Script const& script, std::vector<RecordedSession> const& sessions,
                 AnalysisSettings const& settings = {});

} // namespace study
