#include "study/analysis/threshold_run.h"

#include "gi/core/quantile.h"
#include "study/numeric/random.h"
#include "study/numeric/special.h"
#include "study/script/procedure_settings.h"
#include "study/stats/own_threshold.h"
#include "study/stats/psychometric_posterior.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

constexpr std::size_t kLeastRuns = 20; ///< simulated ones, from which something is taken

/// The value that a further one falls below with this probability (definition 6 of Hyndman & Fan 1996).
double predicted_quantile(std::vector<double> const& values, double probability)
{
    auto const n = double(values.size());
    return gi::quantile(values, std::clamp((probability * (n + 1) - 1) / (n - 1), 0.0, 1.0));
}

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

/// The first two reversals still come from the start.
int counted_reversals(ThresholdRun const& run)
{
    int const all = int(run.reversals.size());
    return all > 4 ? all - 2 : all;
}

/// Means of reversals of simulated runs, in units of the staircase, by an observer with this threshold.
/// @param scale_error  standard error of the logarithm of the group's scale, by which the runs' scales differ
std::vector<double> simulated_means(StaircaseSettings settings, Compare const& c, GroupCurve const& group,
                                    double threshold, double scale_error, ThresholdRun const& run,
                                    std::uint64_t seed)
{
    constexpr int kRuns = 200;
    settings.stop.max_trials = std::max(settings.stop.max_trials, int(run.levels.size()));
    PsychometricShape const shape = group.settings.shape;
    PsychometricParameters p = group.threshold.shared;
    std::vector<double> means;
    for (int i = 0; i < kRuns; ++i) {
        p.scale = group.threshold.shared.scale * std::exp(scale_error * normal_quantile((i + 0.5) / kRuns));
        p.threshold = 0;
        p.threshold = threshold - transformed(shape, level_at(shape, p, group.settings.proportion));
        Random random = Random::part(seed, std::uint64_t(i));
        Staircase staircase(settings);
        while (!staircase.finished()) {
            double const level = back_to_level(c, harder_sign(c) * staircase.level());
            staircase.respond(random.uniform() < proportion_at(shape, p, level));
        }
        int const all = int(staircase.reversals().size());
        if (auto const m = mean_of_reversals(staircase, all > 4 ? all - 2 : all); m && all >= 2)
            means.push_back(*m);
    }
    return means;
}

} // namespace

ThresholdEstimate reversal_estimate(ThresholdRun const& run, Block const& b, Procedure const& p,
                                    std::optional<GroupCurve> const& group, AnalysisSettings const& settings)
{
    ThresholdEstimate e{"mean of reversals", settles_at(p), {}, {}};
    Compare const& c = *b.compare;
    auto const staircase = replayed(p, c, run);
    if (!staircase) {
        e.note = "the recorded levels differ from those that this staircase would have shown";
        return e;
    }
    auto const m = mean_of_reversals(*staircase, counted_reversals(run));
    if (!m || run.reversals.size() < 2) {
        e.note = fmt::format("{} reversals", run.reversals.size());
        return e;
    }
    auto const at = [&](double on_staircase) { return back_to_level(c, harder_sign(c) * on_staircase); };
    e.level = {at(*m), {kUnknown, kUnknown}, 1};
    if (!group) {
        e.note = "not corrected for the bias of means of reversals: no function was fitted";
        return e;
    }
    // The staircase's own error at a threshold where it would, on average, find what it found; twice, since the
    // error depends on where that is.
    StaircaseSettings const rule = staircase_settings(p, c);
    auto const means_at = [&](double on_staircase, double scale_error) {
        return simulated_means(rule, c, *group, transformed(group->settings.shape, at(on_staircase)), scale_error,
                               run, settings.seed);
    };
    double threshold = *m;
    std::vector<double> means;
    for (int i = 0; i < 2; ++i) {
        means = means_at(threshold, 0);
        if (means.size() < kLeastRuns) {
            e.note = "not corrected for the bias of means of reversals: simulated runs have too few of them";
            return e;
        }
        threshold = *m - (mean(means) - threshold);
    }
    // Ends: thresholds at which so extreme a mean would be found with the probability of a tail (test inversion:
    // Carpenter 1999, J. R. Stat. Soc. B 61:159). Runs err more at some thresholds than at others, and more to one
    // side than to the other, and they err more because the group's scale is not known exactly. Shifts by what the
    // simulated means miss lead there in a few steps.
    double const spread = standard_deviation(means), tail = (1 - settings.confidence) / 2;
    auto const end = [&](double direction) {
        double x = threshold - direction * normal_quantile(tail) * spread;
        for (int i = 0; i < 3; ++i) {
            auto const found = means_at(x, group->threshold.scale_error);
            if (found.size() < kLeastRuns) break;
            x += *m - predicted_quantile(found, direction > 0 ? tail : 1 - tail);
        }
        return at(x);
    };
    double const a = end(-1), z = end(1);
    e.level = {at(threshold), {std::min(a, z), std::max(a, z)}, 1};
    return e;
}

/// Lowest proportion correct: the guess rate, or the false alarm rate in the run (log-linear); none if the run
/// has no trials to estimate it.
std::optional<double> lowest_share(Task task, std::vector<TrialRow> const& trials)
{
    if (guess_rate(task) > 0) return guess_rate(task);
    RateCount const noise = false_alarms(trials);
    if (noise.trials == 0) return {};
    return (noise.yes + 0.5) / (noise.trials + 1);
}

RateCount false_alarms(std::vector<TrialRow> const& trials)
{
    RateCount noise;
    for (TrialRow const& row : trials)
        if (row.done->is_correct && row.step->trial.is_noise) {
            noise.trials += 1;
            noise.yes += !*row.done->is_correct;
        }
    return noise;
}

std::string outside_of(double level, double low, double high)
{
    constexpr double kTolerance = 1e-9;
    if (level < low - kTolerance * std::abs(low)) return "below";
    return level > high + kTolerance * std::abs(high) ? "above" : "";
}

void note_outside(ThresholdRun const& run, ThresholdEstimate& e)
{
    auto const [low, high] = std::minmax_element(run.levels.begin(), run.levels.end());
    if (low == run.levels.end()) return;
    std::string const where = outside_of(e.level.value, *low, *high);
    if (where.empty()) return;
    std::string const doubt = fmt::format("the threshold lies {} all levels shown", where);
    e.note += fmt::format("{}{}, {:.4g} to {:.4g}", e.note.empty() ? "" : "; ", doubt, *low, *high);
    e.doubt += (e.doubt.empty() ? "" : "; ") + doubt;
}

std::string cut_end(std::vector<double> const& posterior)
{
    if (posterior.size() < 2) return {};
    double const least = 0.5 * *std::max_element(posterior.begin(), posterior.end());
    bool const below = posterior.front() >= least, above = posterior.back() >= least;
    return below && above ? "lower and upper" : below ? "lower" : above ? "upper" : "";
}

std::string open_ends(Interval const& interval)
{
    bool const below = !std::isfinite(interval.low), above = !std::isfinite(interval.high);
    if (!below && !above) return "";
    return std::string("the interval is open ") + (below && above ? "below and above" : below ? "below" : "above");
}

std::string note_of_open_ends(Interval const& interval, double tail)
{
    std::string const open = open_ends(interval);
    if (open.empty()) return "";
    return fmt::format(
        "{}: more than {:.3g} % of the posterior's functions reach this proportion beyond all levels "
        "or never",
        open, 100 * tail);
}

ThresholdEstimate likelihood_estimate(ThresholdRun const& run, Block const& b, PsychometricChoice const& function,
                                      std::optional<double> guess, double proportion,
                                      std::optional<GroupCurve> const& group, AnalysisSettings const& settings)
{
    ThresholdEstimate e{"likelihood", proportion, {}, {}};
    constexpr char const* kNever = "the function never reaches this proportion";
    if (guess && *guess >= proportion) {
        e.note = "guessing alone reaches this proportion";
        return e;
    }
    try {
        auto const counts = count_levels(run.levels, run.correct);
        PosteriorLevel level;
        PsychometricShape shape = shape_of(b.compare->scale, b.compare->harder_up, function);
        if (group && group->threshold.observers >= 3) {
            shape = group->settings.shape;
            level = own_threshold({counts, guess.value_or(group->threshold.shared.guess)}, group->threshold,
                                  group->settings);
        } else {
            PosteriorSettings s;
            s.shape = shape;
            s.guess = guess.value_or(0);
            s.lapse = settings.lapse;
            s.fits_guess = !guess;
            s.low = b.compare->low;
            s.high = b.compare->high;
            level = posterior_level(psychometric_posterior(counts, s), proportion, settings.confidence);
        }
        StepRates rates;
        rates.guess = guess;
        rates.lapse = settings.lapse;
        auto const gap = step_gap(counts, shape, rates);
        if (gap && std::isfinite(level.centre)) {
            Interval wide{level.low, level.high};
            include_gap(*gap, shape, wide);
            level.low = wide.low;
            level.high = wide.high;
        }
        bool const falls = shape.direction == Direction::falling;
        auto const back = [&](double u) {
            double const x = falls ? -u : u;
            return !std::isfinite(u) ? kUnknown : shape.axis == Axis::log10 ? std::pow(10.0, x) : x;
        };
        if (std::isnan(level.centre)) {
            e.note = kNever;
            return e;
        }
        e.level = {
            back(level.centre), {back(falls ? level.high : level.low), back(falls ? level.low : level.high)}, 1};
        e.note = note_of_open_ends(e.level.interval, (1 - settings.confidence) / 2);
        if (gap) e.note = text_of(*gap) + (e.note.empty() ? "" : "; " + e.note);
        if (!guess)
            e.note = "no trials without a signal: the false alarm rate is that of the fit" +
                     (e.note.empty() ? "" : "; " + e.note);
        int const right = int(std::count(run.correct.begin(), run.correct.end(), 1));
        if (right == int(run.correct.size()))
            e.note = "nothing but correct responses: there is no threshold among these levels";
        Trend trend;
        for (LevelCount const& c : counts) trend.add(transformed(shape, c.level), c.correct, c.trials);
        if (trend.is_falling()) e.note = kWrongDirection + (e.note.empty() ? "" : "; " + e.note);
        if (right == 0) e.note = "no correct response at all: there is no threshold among these levels";
    } catch (std::invalid_argument const& error) {
        e.note = error.what();
    }
    return e;
}

namespace {

/// Where the posterior of a parameter is cut by its prior; not at 0, beyond which there are no rates.
std::string note_of_cut(QuestGrid const& grid, std::vector<double> const& marginal)
{
    std::map<double, double> posterior;
    for (std::size_t i = 0; i < grid.values.size(); ++i)
        if (grid.prior.empty() || grid.prior[i] > 0) posterior[grid.values[i]] += marginal[i];
    std::vector<double> values;
    for (auto const& [unused, v] : posterior) values.push_back(v);
    std::string const end = cut_end(values);
    if (end.empty() || (end == "lower" && posterior.begin()->first == 0)) return {};
    return fmt::format("the posterior is cut at the {} end of its prior, {:.4g} to {:.4g}", end,
                       posterior.begin()->first, posterior.rbegin()->first);
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
        auto const settings = quest_many_settings(p);
        for (std::size_t i = 0; i < names.size(); ++i)
            run.parameters.push_back(
                {names[i], mean[i], sd[i], note_of_cut(settings.parameters[i], quest.marginal(i))});
    } catch (std::invalid_argument const& e) {
        run.note = e.what();
    }
}

} // namespace

double back_to_level(Compare const& compare, double on_scale) { return from_scale(compare.scale, on_scale); }

ThresholdRun threshold_run(Block const& b, Procedure const& p, std::vector<TrialRow> const& trials)
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
    if (p.method == Method::staircase && b.compare)
        if (auto const staircase = replayed(p, *b.compare, run))
            for (Reversal const& r : staircase->reversals()) run.reversals.push_back(r.trial);
    return run;
}

} // namespace study
