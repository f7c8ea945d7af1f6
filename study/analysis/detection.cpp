#include "study/analysis/blocks.h"
#include "study/analysis/threshold_run.h"
#include "study/script/procedure_settings.h"
#include "study/stats/bootstrap.h"
#include "study/stats/dprime.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace study {
namespace {

using RunKey = std::tuple<std::string, int, int, int, int>; ///< cell, procedure, session, pass, run

void add_runs(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
              std::vector<Group> const& groups, AnalysisSettings const& settings, BlockResult& result)
{
    for (ObserverTrials const& o : trials) {
        std::map<RunKey, std::vector<TrialRow>> runs;
        for (TrialRow const& row : o.rows)
            if (row.step->trial.procedure >= 0)
                runs[{cell_name(script, groups, row), row.step->trial.procedure, row.session, row.step->pass,
                      row.step->trial.repeat}]
                    .push_back(row);
        for (auto const& [key, rows] : runs) {
            ThresholdRun run = threshold_run(b, b.procedures[std::size_t(std::get<1>(key))], rows, settings);
            run.participant = o.participant;
            run.cell = std::get<0>(key);
            run.run =
                1 + int(std::count_if(result.runs.begin(), result.runs.end(), [&](ThresholdRun const& r) {
                    return r.participant == run.participant && r.cell == run.cell && r.procedure == run.procedure;
                }));
            if (!run.levels.empty()) result.runs.push_back(std::move(run));
        }
    }
}

/// Means over observers of the estimates of each kind; runs of one observer are averaged first.
void add_summaries(Compare const& c, AnalysisSettings const& settings, BlockResult& result)
{
    std::map<std::tuple<std::string, std::string, std::string, double>, std::map<std::string, std::vector<double>>>
        all;
    for (ThresholdRun const& run : result.runs)
        for (ThresholdEstimate const& e : run.estimates) {
            auto& mine = all[{run.cell, run.procedure, e.method, e.proportion}][run.participant];
            // A fit far from all levels shown is not an estimate.
            bool const is_near =
                e.level.value >= std::min(c.low, c.high) && e.level.value <= std::max(c.low, c.high);
            if (is_near) mine.push_back(to_scale(c.scale, e.level.value));
        }
    for (auto const& [key, people] : all) {
        std::vector<double> means;
        for (auto const& [who, values] : people)
            if (!values.empty()) means.push_back(mean(values));
        Uncertain u = mean_of(means, settings.confidence);
        if (u.n > 0) u.value = from_scale(c.scale, u.value);
        u.interval = {from_scale(c.scale, u.interval.low), from_scale(c.scale, u.interval.high)};
        result.thresholds.push_back({std::get<1>(key), std::get<0>(key), std::get<2>(key), std::get<3>(key), u});
    }
}

std::vector<LevelCount> counts_of(std::vector<TrialRow> const& rows)
{
    std::vector<double> levels;
    std::vector<int> correct;
    for (TrialRow const& row : rows)
        if (row.done->level && row.done->is_correct && !row.step->trial.is_noise) {
            levels.push_back(*row.done->level);
            correct.push_back(*row.done->is_correct ? 1 : 0);
        }
    return count_levels(levels, correct);
}

/// One function through the trials of all observers and procedures in a cell.
CurveResult curve_of(Block const& b, std::string const& cell, std::vector<std::vector<TrialRow>> const& people,
                     AnalysisSettings const& settings)
{
    CurveResult r;
    r.cell = cell;
    r.proportion = (1 + guess_rate(b.task)) / 2;
    std::vector<std::vector<LevelCount>> counts;
    for (auto const& rows : people)
        if (auto c = counts_of(rows); !c.empty()) counts.push_back(std::move(c));
    r.observers = int(counts.size());
    PsychometricSettings s;
    PsychometricChoice const function = fitted_function(b.procedures);
    r.function = function.name();
    s.shape = shape_of(b.compare->scale, b.compare->harder_up, function);
    s.guess.value = guess_rate(b.task);
    if (guess_rate(b.task) == 0) s.guess.limit = 0.5;
    s.lapse = {0.01, 0.06};
    if (settings.guess) s.guess = {*settings.guess, 0};
    if (settings.lapse) s.lapse = {*settings.lapse, 0};
    auto const level = [&](std::span<int const> observers) {
        std::vector<LevelCount> all;
        for (int const o : observers)
            all.insert(all.end(), counts[std::size_t(o)].begin(), counts[std::size_t(o)].end());
        auto const fit = fit_psychometric(all, s);
        double const at = level_at(fit.shape, fit.parameters, r.proportion);
        if (!std::isfinite(at)) throw std::invalid_argument("the function never reaches this proportion");
        return std::vector<double>{to_scale(b.compare->scale, at)};
    };
    try {
        std::vector<LevelCount> all;
        for (auto const& c : counts) all.insert(all.end(), c.begin(), c.end());
        r.fit = fit_psychometric(all, s);
        std::map<double, LevelCount> sums;
        for (LevelCount const& c : all) {
            LevelCount& sum = sums[c.level];
            sum = {c.level, sum.correct + c.correct, sum.trials + c.trials};
        }
        for (auto const& [unused, sum] : sums) r.counts.push_back(sum);
        r.threshold = {level_at(r.fit.shape, r.fit.parameters, r.proportion), {kUnknown, kUnknown}, r.observers};
        BootstrapSettings const bs{std::min(settings.replicates, 400), settings.confidence,
                                   BootstrapInterval::expanded_percentile, settings.seed};
        Interval const i = bootstrap(r.observers, level, bs).interval.front();
        r.threshold.interval = {from_scale(b.compare->scale, i.low), from_scale(b.compare->scale, i.high)};
    } catch (std::invalid_argument const& e) {
        r.refused = e.what();
    }
    return r;
}

struct Tally {
    double correct = 0, trials = 0, hits = 0, signals = 0, false_alarms = 0, noises = 0;
};

/// Rates for a task's d'. Hits: "yes" with a signal, "different" for different stimuli, "first" in ABX if
/// X is the first.
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

double dprime_of(Task task, Tally const& t)
{
    double const p = (t.correct + 0.5) / (t.trials + 1);
    auto const h = (t.hits + 0.5) / (t.signals + 1), f = (t.false_alarms + 0.5) / (t.noises + 1);
    switch (task) {
    case Task::two_interval:
        return mafc_dprime(p, 2);
    case Task::oddity:
        return oddity_dprime(p);
    case Task::abx:
        return abx_dprime(h, f, Strategy::differencing);
    case Task::same_different:
        return same_different_dprime(h, f, Strategy::differencing);
    case Task::yes_no:
        return t.signals > 0 && t.noises > 0
                   ? yes_no(t.hits, t.signals, t.false_alarms, t.noises, Correction::log_linear).dprime
                   : kUnknown;
    default:
        return kUnknown;
    }
}

char const* model_of(Task task)
{
    switch (task) {
    case Task::two_interval:
        return "2-AFC, sqrt(2) z(p)";
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

/// The compared level, or the shown level of the varied setting; and the cell.
std::string condition_of(Script const& script, Block const& b, std::vector<Group> const& groups,
                         TrialRow const& row)
{
    std::string const cell = cell_name(script, groups, row);
    std::string what;
    int const f = compared_factor(b);
    if (f >= 0)
        what = stimulus_label(script, b, row.step->trial.stimuli.front());
    else if (row.done->level)
        what = fmt::format("{} {}", b.compare ? b.compare->vary : "level", level_text(*row.done->level));
    if (what.empty()) return cell;
    return cell == "all" ? what : what + " " + cell;
}

void add_detections(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
                    std::vector<Group> const& groups, AnalysisSettings const& settings, BlockResult& result)
{
    // By cell, then by level, then by name.
    std::map<std::tuple<std::string, double, std::string>, std::vector<Tally>> conditions;
    for (std::size_t o = 0; o < trials.size(); ++o)
        for (TrialRow const& row : trials[o].rows) {
            if (!row.done->is_correct) continue;
            int const procedure = row.step->trial.procedure;
            if (procedure >= 0 && is_adaptive(b.procedures[std::size_t(procedure)])) continue;
            auto& tallies = conditions[{cell_name(script, groups, row),
                                        compared_factor(b) < 0 ? row.done->level.value_or(0) : 0,
                                        condition_of(script, b, groups, row)}];
            tallies.resize(trials.size());
            count(tallies[o], b.task, row);
        }
    for (auto const& [key, tallies] : conditions) {
        DetectionResult d;
        d.condition = std::get<2>(key);
        d.model = model_of(b.task);
        Tally all;
        std::vector<double> each;
        for (Tally const& t : tallies) {
            if (t.trials == 0) continue;
            ++d.observers;
            all = {all.correct + t.correct,
                   all.trials + t.trials,
                   all.hits + t.hits,
                   all.signals + t.signals,
                   all.false_alarms + t.false_alarms,
                   all.noises + t.noises};
            each.push_back(dprime_of(b.task, t));
        }
        d.correct = all.correct;
        d.trials = all.trials;
        d.interval = wilson(all.correct, all.trials, settings.confidence);
        d.dprime = dprime_of(b.task, all);
        d.observer_dprime = mean_of(each, settings.confidence);
        result.detections.push_back(std::move(d));
    }
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
    result.is_log = b.compare->scale != Scale::linear;
    add_runs(script, b, trials, groups, settings, result);
    add_summaries(*b.compare, settings, result);
    bool const is_many =
        std::any_of(b.procedures.begin(), b.procedures.end(), [](Procedure const& p) { return p.is_many(); });
    if (is_many) return; // no curve of one setting
    std::map<std::string, std::vector<std::vector<TrialRow>>> cells;
    for (std::size_t o = 0; o < trials.size(); ++o)
        for (TrialRow const& row : trials[o].rows) {
            auto& cell = cells[cell_name(script, groups, row)];
            cell.resize(trials.size());
            cell[o].push_back(row);
        }
    for (auto const& [name, people] : cells) result.curves.push_back(curve_of(b, name, people, settings));
}

} // namespace study
