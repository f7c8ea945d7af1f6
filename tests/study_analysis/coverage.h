#pragma once
// Simulated experiments of known truth, analysed by the function that `study analyze` calls: biases of estimates
// and coverage of intervals.

#include "study/adaptive/questplus.h"
#include "study/adaptive/staircase.h"
#include "study/analysis/analysis.h"
#include "study/numeric/random.h"
#include "study/script/procedure_settings.h"
#include "study/script/script_file.h"
#include "study/stats/detection_model.h"
#include "tests/study_tables/recorded.h"

#include <cmath>
#include <fmt/format.h>

namespace study::test {

/// What many experiments say of one estimate.
struct Tally {
    std::string name;
    int experiments = 0, covered = 0, below = 0, above = 0; ///< below: the interval ends below the truth
    int unknown = 0;                                        ///< without an estimate or a whole interval
    int estimates = 0;                                      ///< that are finite
    double error = 0;                                       ///< their sum

    void add(double value, Interval const& i, double truth)
    {
        ++experiments;
        if (!std::isfinite(value) || !std::isfinite(i.low) || !std::isfinite(i.high)) ++unknown;
        if (!std::isfinite(value)) return; // covers nothing
        // An end that is not known is taken as infinite.
        bool const is_below = i.high<truth, is_above = i.low> truth;
        below += is_below;
        above += is_above;
        covered += !is_below && !is_above;
        ++estimates;
        error += value - truth;
    }
    double coverage() const { return 100.0 * covered / std::max(1, experiments); }
    double bias() const { return error / std::max(1, estimates); }
};

class SimulatedSession {
public:
    SimulatedSession(Script const& script, int participant)
    {
        session_.plan.participant = participant;
        session_.plan.participant_id = fmt::format("P{:03}", participant);
        session_.record.entries.emplace_back(started(script, session_.plan));
    }
    void add(Trial trial, bool is_right)
    {
        PlanStep step;
        step.block = 0;
        step.number = int(session_.plan.steps.size()) + 1;
        for (std::size_t i = 0; i < trial.stimuli.size(); ++i) trial.order += char('a' + i);
        step.trial = std::move(trial);
        session_.plan.steps.push_back(step);
        int const index = step.number - 1;
        TrialDone done = unanswered(step, index, 100 + 10 * index);
        done.level = step.trial.level;
        done.is_correct = is_right;
        done.response = "answered";
        session_.record.entries.emplace_back(std::move(done));
    }
    RecordedSession finished()
    {
        session_.record.entries.emplace_back(SessionEnded{9999, "2026-11-22T09:00:00.000Z", true, ""});
        return session_;
    }

private:
    RecordedSession session_;
};

struct DetectionExperiment {
    DetectionTask task = DetectionTask::oddity;
    double mean = 0, sd = 0; ///< of d' between observers; never below 0 if the mean is not 0
    int observers = 20, trials = 30;
    double criterion = 0.1, criterion_sd = 0.3; ///< same-different: 0.4 more
};

inline char const* name_of(DetectionTask task)
{
    constexpr char const* kNames[] = {"yes_no", "2ifc", "same_different", "abx", "oddity"};
    return kNames[int(task)];
}

inline Script detection_script(DetectionExperiment const& e)
{
    return parse_script(
        fmt::format(
            "schema: study/1\nid: s\nseed: 1\nparticipants: {{count: {}}}\n"
            "factors: {{q: [a, b]}}\nreference: {{q: a}}\ndefaults: {{stimulus_ms: 500}}\n"
            "sequence: [find]\nblocks:\n  find: {{task: {}, compare: {{factor: q, against: reference}}}}\n",
            e.observers, name_of(e.task)),
        "s.yaml");
}

inline Analysis analyse_detection(DetectionExperiment const& e, std::uint64_t seed,
                                  AnalysisSettings const& settings, std::vector<double>* own = nullptr)
{
    Script const script = detection_script(e);
    Random random = Random::part(seed, 1);
    std::vector<RecordedSession> sessions;
    for (int o = 1; o <= e.observers; ++o) {
        double const d = e.mean + e.sd * random.normal();
        double const c =
            e.criterion + (e.task == DetectionTask::same_different ? 0.4 : 0) + e.criterion_sd * random.normal();
        if (own) own->push_back(d);
        DetectionRates const r = detection_rates(e.task, d, c);
        SimulatedSession session(script, o);
        for (int t = 0; t < e.trials; ++t) {
            bool const is_signal = t % 2 == 0 || e.task == DetectionTask::oddity;
            Trial trial;
            trial.stimuli = {{{1}, false, {}}, {{0}, false, {}}};
            trial.is_noise = e.task == DetectionTask::yes_no && !is_signal;
            trial.answer = e.task == DetectionTask::yes_no           ? (is_signal ? "yes" : "no")
                           : e.task == DetectionTask::same_different ? (is_signal ? "different" : "same")
                           : e.task == DetectionTask::oddity         ? (t % 3 == 0 ? "first" : "second")
                                                                     : (is_signal ? "first" : "second");
            double const p = is_signal ? r.hit.yes : r.false_alarm.no;
            session.add(trial, random.uniform() < p);
        }
        sessions.push_back(session.finished());
    }
    return analyze(script, sessions, settings);
}

struct ThresholdExperiment {
    std::string method = "constant"; ///< constant, staircase, questplus
    int observers = 20;
    double sd = 0.15;    ///< decades, of thresholds between observers
    double slope = 2;    ///< Weibull's
    double slope_sd = 0; ///< of its natural logarithm between observers
    double lapse = 0.02, eta = 0;
    double false_alarms = 0; ///< > 0: yes_no, with as many trials without a signal
};

/// Levels 1 to 100, larger ones easier; the mean threshold at 75 % (yes_no: 50 %) is 10^1.1.
inline constexpr double kMeanThreshold = 1.1;

inline Script threshold_script(ThresholdExperiment const& e)
{
    std::string const procedure =
        e.method == "constant" ? "{method: constant, levels: [2.5, 5.6, 12.6, 28.2, 63.1], trials_per_level: 12}"
        : e.method == "staircase" ? "{method: staircase, up: 1, down: 2, start: 100, steps: [0.4, 0.2, 0.1], "
                                    "stop: {reversals: 10, max_trials: 50}}"
                                  : "{method: questplus, threshold: 1..100/33, slope: [1, 2, 3.5, 5], guess: " +
                                        std::string(e.false_alarms > 0 ? "0.1" : "0.5") +
                                        ", lapse: [0, 0.02, 0.05], stop: {trials: 25}}";
    return parse_script(
        fmt::format(
            "schema: study/1\nid: s\nseed: 1\nparticipants: {{count: {}}}\nfactors: {{scene: [hall]}}\n"
            "reference: {{scene: hall}}\ndefaults: {{stimulus_ms: 500}}\nsequence: [find]\nblocks:\n  find:\n"
            "    task: {}\n    cross: [scene]\n"
            "    compare: {{vary: points, against: reference, scale: log10, range: [1, 100], harder: down}}\n"
            "    procedure: {}\n",
            e.observers, e.false_alarms > 0 ? "yes_no" : "2ifc", procedure),
        "s.yaml");
}

/// Beta(a, b) by two gamma variates (Marsaglia & Tsang 2000).
inline double draw_beta(Random& random, double a, double b)
{
    auto const gamma = [&](double shape) {
        double const boost = shape < 1 ? std::pow(1 - random.uniform(), 1 / shape) : 1;
        double const d = (shape < 1 ? shape + 1 : shape) - 1.0 / 3, c = 1 / std::sqrt(9 * d);
        for (;;) {
            double const x = random.normal(), v = std::pow(1 + c * x, 3);
            if (v > 0 && std::log(1 - random.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v))
                return d * v * boost;
        }
    };
    double const x = gamma(a), y = gamma(b);
    return x / (x + y);
}

struct SimulatedThresholds {
    Analysis analysis;
    double share = 0.75;     ///< of the thresholds below
    std::vector<double> own; ///< each observer's level at `share`, decades
    double at_target = 0;    ///< mean level where a staircase converges, decades
    std::vector<double> own_target;
};

inline SimulatedThresholds analyse_thresholds(ThresholdExperiment const& e, std::uint64_t seed,
                                              AnalysisSettings const& settings)
{
    Script const script = threshold_script(e);
    Block const& block = script.blocks[0];
    Procedure const& procedure = block.procedures[0];
    Compare const& compare = *block.compare;
    Random random = Random::part(seed, 2);
    SimulatedThresholds s;
    double const guess = e.false_alarms > 0 ? e.false_alarms : 0.5;
    s.share = e.false_alarms > 0 ? 0.5 : 0.75;
    // The decades between Weibull's threshold and the level at a share.
    auto const offset = [&](double share, double slope) {
        return std::log10(-std::log1p(-(share - guess) / (1 - guess - e.lapse))) / slope;
    };
    double const target = std::sqrt(0.5);
    std::vector<RecordedSession> sessions;
    for (int o = 1; o <= e.observers; ++o) {
        double const slope = e.slope * std::exp(e.slope_sd * random.normal());
        double const own = kMeanThreshold + e.sd * random.normal(), weibull = own - offset(s.share, slope);
        s.own.push_back(own);
        s.own_target.push_back(weibull + (target > guess ? offset(target, slope) : 0));
        auto const share_at = [&](double level) {
            return guess + (1 - guess - e.lapse) * -std::expm1(-std::pow(level / std::pow(10, weibull), slope));
        };
        SimulatedSession session(script, o);
        auto const ask = [&](double level, double p) {
            bool const is_right = random.uniform() < p;
            Trial trial;
            trial.stimuli = {{{0}, true, {}}, {{0}, false, {}}};
            trial.procedure = 0;
            trial.level = level;
            trial.answer = e.false_alarms > 0 ? "yes" : "first";
            session.add(trial, is_right);
            if (e.false_alarms > 0) {
                trial.answer = "no";
                trial.is_noise = true;
                session.add(trial, !(random.uniform() < e.false_alarms));
            }
            return is_right;
        };
        if (procedure.method == Method::constant) {
            for (double const level : procedure.levels) {
                double p = share_at(level);
                if (e.eta > 0) {
                    double const nu = 1 / (e.eta * e.eta) - 1;
                    p = draw_beta(random, nu * p, nu * (1 - p));
                }
                for (int i = 0; i < procedure.trials_per_level; ++i) ask(level, p);
            }
        } else if (procedure.method == Method::staircase) {
            Staircase staircase(staircase_settings(procedure, compare));
            while (!staircase.finished()) {
                double const level = from_scale(compare.scale, harder_sign(compare) * staircase.level());
                staircase.respond(ask(level, share_at(level)));
            }
        } else {
            QuestSettings const q = quest_settings(procedure, compare);
            QuestPlus quest(q);
            for (int i = 0; i < procedure.stop.trials; ++i) {
                std::size_t const next = quest.next();
                double const level = procedure.stimuli[next];
                quest.respond(next, ask(level, share_at(level)));
            }
        }
        sessions.push_back(session.finished());
    }
    s.at_target = kMeanThreshold - offset(s.share, e.slope) + offset(target, e.slope);
    s.analysis = analyze(script, sessions, settings);
    return s;
}

} // namespace study::test
