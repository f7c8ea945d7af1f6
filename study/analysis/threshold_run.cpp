#include "study/analysis/threshold_run.h"

#include "study/script/procedure_settings.h"
#include "study/stats/root.h"
#include "study/stats/special.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Proportion in the middle between guessing and 1.
double middle(Task task) { return (1 + guess_rate(task)) / 2; }

/// Replays the staircase; empty if the recorded levels differ from those that it would have shown.
std::optional<Staircase> replayed(Procedure const& p, Compare const& c, ThresholdRun const& run)
{
    StaircaseSettings settings = staircase_settings(p, c);
    settings.stop = {0, 0, 1 << 20}; // the record determines its end
    Staircase staircase(settings);
    for (std::size_t i = 0; i < run.levels.size(); ++i) {
        double const level = harder_sign(c) * to_scale(c.scale, run.levels[i]);
        if (!(std::abs(level - staircase.level()) < 1e-6 * std::max(1.0, std::abs(level)))) return std::nullopt;
        staircase.respond(run.correct[i] != 0);
    }
    return staircase;
}

void add_staircase(ThresholdRun& run, Block const& b, Procedure const& p)
{
    ThresholdEstimate e{"mean of reversals", settles_at(p), {}, {}};
    auto const staircase = replayed(p, *b.compare, run);
    if (!staircase) {
        e.note = "the recorded levels differ from those that this staircase would have shown";
    } else {
        for (Reversal const& r : staircase->reversals()) run.reversals.push_back(r.trial);
        // The first two still come from the start.
        int const all = int(run.reversals.size()), last = all > 4 ? all - 2 : all;
        if (auto const m = mean_of_reversals(*staircase, last); m && all >= 2)
            e.level = {back_to_level(*b.compare, harder_sign(*b.compare) * *m), {kUnknown, kUnknown}, 1};
        else
            e.note = fmt::format("{} reversals", all);
    }
    run.estimates.push_back(std::move(e));
}

/// Lowest proportion correct: the guess rate, or the false alarm rate in the run (log-linear); none if the run
/// has no trials to estimate it.
std::optional<double> lowest_share(Task task, std::vector<TrialRow> const& trials)
{
    if (guess_rate(task) > 0) return guess_rate(task);
    double false_alarms = 0, noises = 0;
    for (TrialRow const& row : trials)
        if (row.done->is_correct && row.step->trial.is_noise) {
            noises += 1;
            false_alarms += !*row.done->is_correct;
        }
    if (noises == 0) return {};
    return (false_alarms + 0.5) / (noises + 1);
}

void add_maximum_likelihood(ThresholdRun& run, Block const& b, std::optional<double> guess, double proportion,
                            PsychometricChoice const& function, AnalysisSettings const& settings)
{
    ThresholdEstimate e{"maximum likelihood", proportion, {}, {}};
    try {
        PsychometricSettings s;
        s.shape = shape_of(b.compare->scale, b.compare->harder_up, function);
        s.guess.value = guess.value_or(0);
        s.lapse.value = 0.02; // one run cannot determine lapses
        if (settings.guess) s.guess.value = *settings.guess;
        if (settings.lapse) s.lapse.value = *settings.lapse;
        auto const fit = fit_psychometric(count_levels(run.levels, run.correct), s);
        auto const on_u = [&](double level) { return transformed(fit.shape, level); };
        double const level = level_at(fit.shape, fit.parameters, proportion);
        e.note = fit.note;
        if (e.note.empty() && !guess) e.note = "no trials without a signal: a false alarm rate of 0 is assumed";
        double const error = fit.standard_error.threshold;
        if (std::isfinite(level)) {
            e.level = {level, {kUnknown, kUnknown}, 1};
            // The error of the threshold, applied to a level at a fixed distance from it on the scale.
            if (error > 0 && std::isfinite(error)) {
                double const half = normal_quantile((1 + settings.confidence) / 2) * error, u = on_u(level);
                auto const back = [&](double v) {
                    double const x = fit.shape.direction == Direction::falling ? -v : v;
                    return fit.shape.axis == Axis::log10 ? std::pow(10.0, x) : x;
                };
                e.level.interval = {std::min(back(u - half), back(u + half)),
                                    std::max(back(u - half), back(u + half))};
            }
        } else if (fit.note.empty())
            e.note = "the fitted function never reaches this proportion";
    } catch (std::invalid_argument const& error) {
        e.note = error.what();
    }
    run.estimates.push_back(std::move(e));
}

void add_questplus(ThresholdRun& run, Block const& b, Procedure const& p, double proportion,
                   AnalysisSettings const& settings)
{
    Compare const& c = *b.compare;
    ThresholdEstimate e{"QUEST+ posterior", proportion, {}, {}};
    QuestSettings const s = quest_settings(p, c);
    bool const takes_levels = assumed_function(p).takes_levels();
    auto const on_axis = [&](double level) { return takes_levels ? level : to_scale(c.scale, level); };
    try {
        QuestPlus quest(s);
        for (std::size_t i = 0; i < run.levels.size(); ++i) {
            auto const nearest = std::min_element(s.stimuli.begin(), s.stimuli.end(), [&](double x, double y) {
                return std::abs(x - on_axis(run.levels[i])) < std::abs(y - on_axis(run.levels[i]));
            });
            quest.respond(std::size_t(nearest - s.stimuli.begin()), run.correct[i] != 0);
        }
        // In the scale's unit: the posterior's grid is even on the scale, not on levels.
        auto const posterior = quest.threshold_posterior();
        QuestParameters mean = quest.mean();
        double m = 0, squares = 0;
        for (std::size_t i = 0; i < posterior.size(); ++i) {
            double const t = to_scale(c.scale, p.threshold[i]);
            m += posterior[i] * t;
            squares += posterior[i] * t * t;
        }
        double const half =
            normal_quantile((1 + settings.confidence) / 2) * std::sqrt(std::max(0.0, squares - m * m));
        mean.threshold = on_axis(from_scale(c.scale, m));
        // The level where the function of the posterior's mean has that proportion.
        double const width = to_scale(c.scale, c.high) - to_scale(c.scale, c.low);
        double const low = to_scale(c.scale, c.low) - width, high = to_scale(c.scale, c.high) + width;
        auto const above = [&](double at) { // the wanted proportion
            return proportion_by(s, mean, on_axis(from_scale(c.scale, at))) - proportion;
        };
        double const at_low = above(low), at_high = above(high);
        if (at_low * at_high < 0) {
            double const sign = at_low < 0 ? 1 : -1;
            double const at = bisect([&](double x) { return sign * above(x); }, low, high);
            double const a = from_scale(c.scale, at - half), z = from_scale(c.scale, at + half);
            e.level = {from_scale(c.scale, at), {std::min(a, z), std::max(a, z)}, 1};
        } else
            e.note = "the function of the posterior's mean never reaches this proportion";
    } catch (std::invalid_argument const& error) {
        e.note = error.what();
    }
    run.estimates.push_back(std::move(e));
}

/// Replays QUEST+ of several settings on the recorded trials.
void add_parameters(ThresholdRun& run, Block const& b, Procedure const& p, std::vector<TrialRow> const& trials)
{
    try {
        QuestPlusMany quest(quest_many_settings(p));
        for (TrialRow const& row : trials) {
            if (!row.done->level || !row.done->is_correct || row.step->trial.is_noise) continue;
            std::vector<double> stimulus{*row.done->level};
            for (double const level : further_of_text(*b.compare, row.done->chosen)) stimulus.push_back(level);
            auto const index = stimulus.size() == 1 + p.also.size() ? quest.index_of(stimulus) : std::nullopt;
            if (!index) {
                run.note = "a recorded level is not on the grid";
                return;
            }
            quest.respond(*index, *row.done->is_correct);
        }
        auto const mean = quest.mean(), sd = quest.standard_deviation();
        auto const names = names_of({}, quest_many_settings(p).parameters);
        for (std::size_t i = 0; i < names.size(); ++i) run.parameters.push_back({names[i], mean[i], sd[i]});
    } catch (std::invalid_argument const& e) {
        run.note = e.what();
    }
}

} // namespace

double guess_rate(Task task)
{
    if (task == Task::oddity) return 1.0 / 3;
    // Proportions of yes and different go down to the false alarm rate, which is fitted.
    return task == Task::yes_no || task == Task::same_different ? 0 : 0.5;
}

double back_to_level(Compare const& compare, double on_scale) { return from_scale(compare.scale, on_scale); }

ThresholdRun threshold_run(Block const& b, Procedure const& p, std::vector<TrialRow> const& trials,
                           AnalysisSettings const& settings)
{
    ThresholdRun run;
    run.procedure = p.name;
    for (TrialRow const& row : trials)
        if (row.done->level && row.done->is_correct && !row.step->trial.is_noise) {
            run.levels.push_back(*row.done->level);
            run.correct.push_back(*row.done->is_correct ? 1 : 0);
        }
    if (p.is_many()) {
        add_parameters(run, b, p, trials);
        return run;
    }
    auto const guess = lowest_share(b.task, trials);
    // Every method at the middle of the rise; staircases also at the proportion to which they converge.
    if (p.method == Method::staircase) {
        add_staircase(run, b, p);
        if (settles_at(p) > guess_rate(b.task))
            add_maximum_likelihood(run, b, guess, settles_at(p), fitted_function({p}), settings);
    }
    add_maximum_likelihood(run, b, guess, middle(b.task), fitted_function({p}), settings);
    if (p.method == Method::questplus) add_questplus(run, b, p, middle(b.task), settings);
    return run;
}

} // namespace study
