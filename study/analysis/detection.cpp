#include "study/analysis/blocks.h"
#include "study/analysis/hierarchical_result.h"
#include "study/analysis/threshold_run.h"
#include "study/stats/binomial.h"
#include "study/stats/group_dprime.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace study {
namespace {

constexpr double kShareOfError = 2e-3;

struct Tally {
    double correct = 0, trials = 0, hits = 0, signals = 0, false_alarms = 0, noises = 0;
};

/// Rates for a task's d'. Hits: "yes" with a signal, "different" for different stimuli,
/// "first" in ABX if X is the first.
void count(Tally& t, Task task, TrialRow const& row)
{
    bool const right = row.done->is_correct.value_or(false);
    t.correct += right;
    t.trials += 1;
    std::string const& answer = row.step->trial.answer;
    bool const is_signal = task == Task::yes_no           ? answer == "yes"
                           : task == Task::same_different ? answer == "different"
                                                          : answer == "first";
    (is_signal ? t.signals : t.noises) += 1;
    if (is_signal)
        t.hits += right;
    else
        t.false_alarms += !right;
}

std::optional<DetectionTask> detection_task(Task task)
{
    switch (task) {
    case Task::two_interval:
        return DetectionTask::two_interval;
    case Task::oddity:
        return DetectionTask::oddity;
    case Task::abx:
        return DetectionTask::abx;
    case Task::same_different:
        return DetectionTask::same_different;
    case Task::yes_no:
        return DetectionTask::yes_no;
    default:
        return {};
    }
}

/// Where only one of the answers "first" and "second" was ever right, nothing is known of a bias between them:
/// right answers count half for each.
DetectionCounts counts_of(Task task, Tally const& t, bool has_both)
{
    if (task == Task::oddity) return {t.correct, t.trials, 0, 0};
    bool const is_forced = task == Task::two_interval || task == Task::abx;
    if (is_forced && !has_both) return {t.correct / 2, t.trials / 2, (t.trials - t.correct) / 2, t.trials / 2};
    return {t.hits, t.signals, t.false_alarms, t.noises};
}

char const* model_of(Task task)
{
    switch (task) {
    case Task::two_interval:
        return "2-AFC, (z(H) - z(F)) / sqrt 2";
    case Task::oddity:
        return "oddity (Frijters 1979)";
    case Task::abx:
        return "ABX, differencing";
    case Task::same_different:
        return "same-different, differencing";
    case Task::yes_no:
        return "yes/no, z(H) - z(F)";
    default:
        return "";
    }
}

/// Why these trials have no d'; empty = they have one.
std::string without_dprime(Task task, DetectionCounts const& all, AnalysisSettings const& settings)
{
    auto const model = detection_task(task);
    // A guess rate that was given may be another task's, such as that of four alternatives.
    constexpr double kRounding = 0.01;
    double const guess = guess_rate(task);
    if (model && guess > 0 && std::abs(settings.guess.value_or(guess) - guess) > kRounding)
        return fmt::format("no d': its model guesses {:.3g} right, not the {:g} of --guess", guess,
                           *settings.guess);
    if (!model || !has_criterion(*model) || (all.signals > 0 && all.noises > 0)) return {};
    bool const is_yes_no = task == Task::yes_no;
    return all.signals > 0 ? fmt::format("no d': no trial {}, so that the rate of false alarms is unknown",
                                         is_yes_no ? "is without a signal" : "has the same stimuli")
                           : fmt::format("no d': no trial {}, so that the rate of hits is unknown",
                                         is_yes_no ? "has a signal" : "has different stimuli");
}

/// d' of all trials pooled, and the mean of the population.
void add_dprime(DetectionResult& d, Block const& b, std::vector<DetectionCounts> const& counts,
                DetectionCounts const& all, AnalysisSettings const& settings)
{
    auto const task = detection_task(b.task);
    if (!task) return;
    d.dprime = detection_point(*task, all).dprime;
    try {
        GroupDPrime const g = group_dprime(*task, counts, settings.confidence, settings.has_deviations);
        // What is far below its error is where the search for the best fit ended.
        double const error = (g.interval.high - g.interval.low) / 2;
        double const least = kShareOfError * (std::isfinite(error) ? error : 1);
        auto const fitted = [&](double v) { return std::abs(v) < least ? 0 : v; };
        d.observer_dprime = {fitted(g.mean), g.interval, int(g.observer.size())};
        if (g.observer.size() > 1) d.deviation = g.deviation > 1.1 * kLeastDPrimeSd ? g.deviation : 0;
        Interval const i = g.deviation_interval; // around 0 it begins at 0
        d.deviation_interval = {std::fmin(i.low, d.deviation), std::fmax(i.high, d.deviation)};
        if (std::isnan(i.low)) d.deviation_interval = i;
        d.p = g.p;
        if (has_criterion(*task)) d.criterion = fitted(g.criterion);
        d.note = g.note;
    } catch (std::invalid_argument const& e) {
        d.note = e.what();
    }
}

HierarchicalResult hierarchical_of(DetectionResult const& d, Block const& b,
                                   std::vector<DetectionCounts> const& counts, std::vector<std::string> const& who,
                                   AnalysisSettings const& settings)
{
    HierarchicalResult r;
    r.condition = d.condition;
    r.parameter = "d'";
    r.observers = int(who.size());
    r.participants = who;
    try {
        fill(r,
             hierarchical_dprime(*detection_task(b.task), counts, settings.confidence,
                                 sampler_of(settings, r.parameter + ", " + r.condition)),
             [](double v) { return v; });
    } catch (std::invalid_argument const& e) {
        r.refused = e.what();
    }
    return r;
}

/// The compared level or pair, or the shown level of the varied setting; and the cell.
std::string condition_of(Script const& script, Block const& b, std::vector<Group> const& groups,
                         std::map<double, std::string> const& levels, TrialRow const& row)
{
    std::string const cell = cell_name(script, groups, row);
    std::string what;
    int const f = compared_factor(b);
    if (f >= 0)
        what = compared_label(script, b, row.step->trial);
    else if (row.done->level)
        what = fmt::format("{} {}", b.compare ? b.compare->vary : "level", levels.at(*row.done->level));
    if (what.empty()) return cell;
    return cell == "all" ? what : what + " " + cell;
}

void add_detections(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
                    std::vector<Group> const& groups, AnalysisSettings const& settings, BlockResult& result)
{
    auto const levels = level_names(trials);
    // By cell, then by level, then by name.
    std::map<std::tuple<std::string, double, std::string>, std::vector<Tally>> conditions;
    for (std::size_t o = 0; o < trials.size(); ++o)
        for (TrialRow const& row : trials[o].rows) {
            if (!row.done->is_correct) continue;
            int const procedure = row.step->trial.procedure;
            if (procedure >= 0 && is_adaptive(b.procedures[std::size_t(procedure)])) continue;
            auto& tallies = conditions[{cell_name(script, groups, row),
                                        compared_factor(b) < 0 ? row.done->level.value_or(0) : 0,
                                        condition_of(script, b, groups, levels, row)}];
            tallies.resize(trials.size());
            count(tallies[o], b.task, row);
        }
    std::map<std::string, std::vector<std::size_t>> without; // conditions, by why they have no d'
    for (auto const& [key, tallies] : conditions) {
        DetectionResult d;
        d.condition = std::get<2>(key);
        d.model = model_of(b.task);
        Tally all;
        std::vector<std::string> who;
        for (std::size_t o = 0; o < tallies.size(); ++o) {
            Tally const& t = tallies[o];
            if (t.trials == 0) continue;
            who.push_back(trials[o].participant);
            all = {all.correct + t.correct,
                   all.trials + t.trials,
                   all.hits + t.hits,
                   all.signals + t.signals,
                   all.false_alarms + t.false_alarms,
                   all.noises + t.noises};
        }
        d.observers = int(who.size());
        d.correct = all.correct;
        d.trials = all.trials;
        d.interval = wilson(all.correct, all.trials, settings.confidence);
        bool const has_both = all.signals > 0 && all.noises > 0;
        std::vector<DetectionCounts> counts;
        for (Tally const& t : tallies)
            if (t.trials > 0) counts.push_back(counts_of(b.task, t, has_both));
        DetectionCounts const pooled = counts_of(b.task, all, has_both);
        if (std::string const why = without_dprime(b.task, pooled, settings); !why.empty()) {
            without[why].push_back(result.detections.size());
            d.model.clear();
        } else
            add_dprime(d, b, counts, pooled, settings);
        // Of a varied level thresholds are the aim, and every level would have a model of its own.
        bool const is_varied = b.compare && !b.compare->vary.empty();
        if (settings.draws > 0 && !is_varied && std::isfinite(d.dprime) && counts.size() > 1)
            result.hierarchical.push_back(hierarchical_of(d, b, counts, who, settings));
        result.detections.push_back(std::move(d));
    }
    for (auto const& [why, which] : without)
        result.detections[which[0]].note =
            which.size() == 1 ? why
                              : fmt::format("{} (in {} of {} conditions)", why, which.size(), conditions.size());
}

} // namespace

void analyze_detection(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                       AnalysisSettings const& settings, BlockResult& result)
{
    Block const& b = script.blocks[std::size_t(block)];
    auto const trials = counted(observers, block);
    auto const groups = groups_of(script, observers, block, {compared_factor(b)});
    add_detections(script, b, trials, groups, settings, result);
    if (!b.compare || b.compare->vary.empty()) return;
    analyze_thresholds(script, b, trials, groups, settings, result);
}

} // namespace study
