#include "study/analysis/blocks.h"
#include "study/analysis/hierarchical_result.h"
#include "study/analysis/own_fit.h"
#include "study/analysis/threshold_run.h"
#include "study/numeric/special.h"
#include "study/script/procedure_settings.h"
#include "study/stats/summary.h"
#include "study/stats/threshold_marginal.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Proportion in the middle between guessing and 1.
double middle(Task task) { return (1 + guess_rate(task)) / 2; }

/// u of shape_of in units of the comparison's scale: a decade is log2(10) octaves.
double scale_units(Compare const& c) { return c.scale == Scale::linear ? 1 : to_scale(c.scale, 10); }

double level_of(PsychometricShape const& shape, double u)
{
    double const x = shape.direction == Direction::falling ? -u : u;
    return shape.axis == Axis::log10 ? std::pow(10.0, x) : x;
}

Uncertain level_of(PsychometricShape const& shape, double u, Interval const& interval, int observers)
{
    auto const end = [&](double v) { return std::isfinite(v) ? level_of(shape, v) : kUnknown; };
    double const a = end(interval.low), b = end(interval.high);
    bool const falls = shape.direction == Direction::falling;
    return {level_of(shape, u), {falls ? b : a, falls ? a : b}, observers};
}

/// Of thresholds between observers, in units of the scale: 0 where it is fitted as the least possible.
double deviation_of(GroupCurve const& g, Compare const& c)
{
    if (g.threshold.observers < 2) return kUnknown;
    double const range = std::abs(transformed(g.settings.shape, c.high) - transformed(g.settings.shape, c.low));
    return g.threshold.deviation > 1.1 * kLeastThresholdSd * range ? g.threshold.deviation * scale_units(c) : 0;
}

/// Its interval, in units of the scale; around 0 it begins at 0.
Interval deviation_interval_of(GroupCurve const& g, Compare const& c)
{
    double const deviation = deviation_of(g, c), unit = scale_units(c);
    Interval const i = g.threshold.deviation_interval;
    if (std::isnan(i.low)) return i;
    return {std::min(i.low * unit, deviation), std::max(i.high * unit, deviation)};
}

/// One observer's run with the rows it is made of.
struct RunOf {
    ThresholdRun run;
    std::optional<double> guess;
    RateCount noise{};         ///< trials without a signal from which `guess` was estimated
    bool is_own_noise = false; ///< those of the run, not of all its cell
};
using Place = std::pair<std::string, int>; ///< cell, procedure

std::map<Place, std::vector<RunOf>> runs_of(Script const& script, Block const& b,
                                            std::vector<ObserverTrials> const& trials,
                                            std::vector<Group> const& groups, AnalysisSettings const& settings)
{
    using RunKey = std::tuple<std::string, int, int, int, int>; // cell, procedure, session, pass, run
    std::map<Place, std::vector<RunOf>> all;
    for (ObserverTrials const& o : trials) {
        std::map<RunKey, std::vector<TrialRow>> runs;
        std::map<std::string, std::vector<TrialRow>> cells;
        for (TrialRow const& row : o.rows) {
            std::string const cell = cell_name(script, groups, row);
            cells[cell].push_back(row);
            if (row.step->trial.procedure >= 0)
                runs[{cell, row.step->trial.procedure, row.session, row.step->pass, row.step->trial.repeat}]
                    .push_back(row);
        }
        for (auto const& [key, rows] : runs) {
            int const procedure = std::get<1>(key);
            RunOf r{threshold_run(b, b.procedures[std::size_t(procedure)], rows), lowest_share(b.task, rows)};
            if (r.run.levels.empty()) continue;
            auto const& cell = cells.at(std::get<0>(key));
            r.is_own_noise = r.guess.has_value();
            if (!r.guess) r.guess = lowest_share(b.task, cell);
            if (guess_rate(b.task) == 0 && !settings.guess) r.noise = false_alarms(r.is_own_noise ? rows : cell);
            if (settings.guess) r.guess = settings.guess;
            r.run.participant = o.participant;
            r.run.has_order = o.detail == TrialDetail::trials;
            r.run.cell = std::get<0>(key);
            auto& list = all[{r.run.cell, procedure}];
            r.run.run = 1 + int(std::count_if(list.begin(), list.end(), [&](RunOf const& other) {
                            return other.run.participant == o.participant;
                        }));
            list.push_back(std::move(r));
        }
    }
    return all;
}

GroupThresholdSettings group_settings(Compare const& c, PsychometricChoice const& function, double proportion,
                                      AnalysisSettings const& settings)
{
    GroupThresholdSettings s;
    s.shape = shape_of(c.scale, c.harder_up, function);
    s.lapse = settings.lapse;
    s.proportion = proportion;
    s.low = c.low;
    s.high = c.high;
    s.confidence = settings.confidence;
    s.has_deviation = settings.has_deviations;
    return s;
}

/// Keeps observers whose false alarm rate is well below the proportion; returns the number of the others.
int leave_out_guessers(std::vector<ObserverLevels>& observers, std::vector<std::string>& who, double proportion)
{
    constexpr double kRoom = 0.03;
    int left_out = 0;
    for (std::size_t i = observers.size(); i-- > 0;)
        if (observers[i].guess > proportion - kRoom) {
            observers.erase(observers.begin() + std::ptrdiff_t(i));
            who.erase(who.begin() + std::ptrdiff_t(i));
            ++left_out;
        }
    return left_out;
}

std::string left_out_note(int left_out)
{
    return left_out == 0 ? ""
           : left_out == 1
               ? "1 observer whose false alarms alone reach the proportion is left out"
               : fmt::format("{} observers whose false alarms alone reach the proportion are left out", left_out);
}

void append(std::string& note, std::string const& more)
{
    if (!more.empty()) note += (note.empty() ? "" : "; ") + more;
}

struct GroupData {
    std::vector<ObserverLevels> observers;
    std::vector<std::string> who;
    bool fits_guess = false;
    std::map<std::string, double> rates; ///< false alarm rates given those of all, of observers with such trials
    std::string note;
};

/// Levels of each observer. @param runs of one procedure, or of all procedures in a cell
GroupData data_of(std::vector<RunOf const*> const& runs, double proportion)
{
    GroupData d;
    std::map<std::string, std::pair<std::vector<double>, std::vector<int>>> people;
    std::map<std::string, std::optional<double>> guess;
    std::map<std::string, RateCount> noise;
    for (RunOf const* r : runs) {
        auto& [levels, correct] = people[r->run.participant];
        levels.insert(levels.end(), r->run.levels.begin(), r->run.levels.end());
        correct.insert(correct.end(), r->run.correct.begin(), r->run.correct.end());
        guess[r->run.participant] = r->guess;
        RateCount& own = noise[r->run.participant];
        own = r->is_own_noise ? RateCount{own.yes + r->noise.yes, own.trials + r->noise.trials} : r->noise;
        d.fits_guess = d.fits_guess || !r->guess;
    }
    for (auto const& [who, data] : people) {
        d.observers.push_back({count_levels(data.first, data.second), d.fits_guess ? 0 : guess[who].value_or(0)});
        d.who.push_back(who);
    }
    std::vector<RateCount> counts;
    double noises = 0;
    for (auto const& [who, count] : noise) {
        counts.push_back(count);
        noises += count.trials;
    }
    if (!d.fits_guess && noises > 0) {
        std::vector<double> const rates = shrunken_rates(counts);
        for (std::size_t i = 0; i < rates.size(); ++i) // by name, as counts are
            d.observers[i].guess = d.rates[d.who[i]] = rates[i];
    }
    if (!d.fits_guess) d.note = left_out_note(leave_out_guessers(d.observers, d.who, proportion));
    return d;
}

/// Where the answers of each observer jump between two neighbouring levels, a threshold may be anywhere between them:
/// says so, and, if they do for all observers between the same two, makes the interval as wide.
void note_gaps(GroupData const& data, GroupCurve& g, std::string& note)
{
    std::vector<StepGap> gaps;
    for (ObserverLevels const& o : data.observers) {
        StepRates rates;
        if (!data.fits_guess) rates.guess = o.guess;
        rates.lapse = g.settings.lapse;
        auto const gap = step_gap(o.counts, g.settings.shape, rates);
        if (!gap) return;
        gaps.push_back(*gap);
    }
    if (gaps.empty()) return;
    if (!std::all_of(gaps.begin(), gaps.end(), [&](StepGap const& gap) { return gap == gaps[0]; })) {
        append(note,
               "the answers of each observer change from guessing to knowing between two neighbouring levels: any "
               "thresholds between these fit equally well");
        return;
    }
    append(note, text_of(gaps[0]));
    include_gap(gaps[0], g.settings.shape, g.threshold.interval);
}

/// Says if the mean lies beyond all levels that were shown, within the range on offer.
void note_outside(GroupData const& data, GroupCurve& g)
{
    double low = INFINITY, high = -INFINITY;
    for (ObserverLevels const& o : data.observers)
        for (LevelCount const& l : o.counts) {
            low = std::min(low, l.level);
            high = std::max(high, l.level);
        }
    std::string const where = outside_of(level_of(g.settings.shape, g.threshold.mean), low, high);
    if (!where.empty() && g.threshold.note.find("outside the range") == std::string::npos)
        append(g.threshold.note,
               fmt::format("the mean threshold lies {} all levels shown, {:.4g} to {:.4g}", where, low, high));
}

std::optional<GroupCurve> group_curve(Compare const& c, PsychometricChoice const& function, GroupData const& data,
                                      double proportion, AnalysisSettings const& settings, std::string& note)
{
    GroupCurve g{group_settings(c, function, proportion, settings), {}};
    g.settings.fits_guess = data.fits_guess;
    try {
        g.threshold = group_threshold(data.observers, g.settings);
        Interval const interval = level_of(g.settings.shape, g.threshold.mean, g.threshold.interval, 0).interval;
        if (std::string const open = open_ends(interval); !open.empty())
            append(g.threshold.note, open + ": the answers do not exclude means far beyond all levels");
        note_outside(data, g);
        note_gaps(data, g, g.threshold.note);
        append(note, g.threshold.note);
        append(note, data.note);
        return g;
    } catch (std::invalid_argument const& e) {
        append(note, e.what());
        return {};
    }
}

/// Mean over observers of levels on the scale; those of one observer are averaged first.
void average(ThresholdSummary& s, Compare const& c, std::map<std::string, std::vector<double>> const& by_observer,
             AnalysisSettings const& settings)
{
    std::vector<double> means;
    for (auto const& [who, values] : by_observer) means.push_back(mean(values));
    Uncertain u = mean_of(means, settings.confidence);
    s.deviation = standard_deviation(means);
    if (auto const n = double(means.size()); n > 1 && s.deviation > 0) {
        double const tail = (1 - settings.confidence) / 2;
        auto const end = [&](double share) {
            return s.deviation * std::sqrt((n - 1) / chi_square_quantile(share, n - 1));
        };
        s.deviation_interval = {end(1 - tail), end(tail)};
    }
    if (u.is_constant) append(s.note, "no variation between observers: no interval");
    if (u.n > 0) u.value = from_scale(c.scale, u.value);
    u.interval = {from_scale(c.scale, u.interval.low), from_scale(c.scale, u.interval.high)};
    s.level = u;
}

/// As add_proportion, by a formula: a mean over observers, without those far from all levels shown.
void add_proportion_by_formula(Block const& b, PsychometricChoice const& function, std::vector<RunOf>& runs,
                               double proportion, AnalysisSettings const& settings, BlockResult& result)
{
    Compare const& c = *b.compare;
    ThresholdSummary s{runs.front().run.procedure,
                       runs.front().run.cell,
                       "maximum likelihood",
                       proportion,
                       {},
                       kUnknown,
                       {kUnknown, kUnknown},
                       {}};
    std::map<std::string, std::vector<double>> by_observer;
    int outside = 0;
    for (RunOf& r : runs) {
        ThresholdEstimate e = maximum_likelihood_estimate(r.run, b, function, r.guess, proportion, settings);
        if (e.level.value >= c.low && e.level.value <= c.high)
            by_observer[r.run.participant].push_back(to_scale(c.scale, e.level.value));
        else
            ++outside;
        r.run.estimates.push_back(std::move(e));
    }
    if (outside > 0)
        append(s.note, fmt::format("{} of {} runs without a threshold in the range of levels are left out",
                                   outside, runs.size()));
    average(s, c, by_observer, settings);
    result.thresholds.push_back(std::move(s));
}

/// The population's threshold at one proportion by one procedure, and those of its runs.
/// @return the group's curve; none = it was not fitted
std::optional<GroupCurve> add_proportion(Block const& b, Procedure const& p, std::vector<RunOf>& runs,
                                         double proportion, bool with_reversals, AnalysisSettings const& settings,
                                         BlockResult& result)
{
    Compare const& c = *b.compare;
    PsychometricChoice const function = fitted_function({p}, c.scale);
    std::vector<RunOf const*> all;
    for (RunOf const& r : runs) all.push_back(&r);
    ThresholdSummary likelihood{
        p.name, runs.front().run.cell, "likelihood", proportion, {}, kUnknown, {kUnknown, kUnknown}, {}};
    std::optional<GroupCurve> group;
    GroupData const data = data_of(all, proportion);
    if (!function.formula) group = group_curve(c, function, data, proportion, settings, likelihood.note);
    if (group) {
        GroupThreshold const& g = group->threshold;
        likelihood.level = level_of(group->settings.shape, g.mean, g.interval, g.observers);
        likelihood.deviation = deviation_of(*group, c);
        likelihood.deviation_interval = deviation_interval_of(*group, c);
    }
    ThresholdSummary reversals{
        p.name, runs.front().run.cell, "mean of reversals", proportion, {}, kUnknown, {kUnknown, kUnknown}, {}};
    std::map<std::string, std::vector<double>> by_observer;
    for (RunOf& r : runs) {
        if (with_reversals) {
            r.run.estimates.push_back(reversal_estimate(r.run, b, p, group, settings));
            double const level = r.run.estimates.back().level.value;
            if (std::isfinite(level)) by_observer[r.run.participant].push_back(to_scale(c.scale, level));
        }
        if (function.formula) continue;
        if (settings.guess && settings.lapse)
            r.run.estimates.push_back(
                maximum_likelihood_estimate(r.run, b, function, r.guess, proportion, settings));
        auto const rate = data.rates.find(r.run.participant);
        r.run.estimates.push_back(likelihood_estimate(
            r.run, b, function, rate != data.rates.end() ? rate->second : r.guess, proportion, group, settings));
    }
    if (with_reversals) {
        average(reversals, c, by_observer, settings);
        result.thresholds.push_back(std::move(reversals));
    }
    if (function.formula)
        add_proportion_by_formula(b, function, runs, proportion, settings, result);
    else
        result.thresholds.push_back(std::move(likelihood));
    return group;
}

HierarchicalResult hierarchical_of(Block const& b, PsychometricChoice const& function, std::string const& cell,
                                   GroupData const& data, double proportion, AnalysisSettings const& settings)
{
    Compare const& c = *b.compare;
    HierarchicalResult r;
    r.condition = cell;
    r.parameter = fmt::format("threshold at {:.0f} %", 100 * proportion);
    r.observers = int(data.who.size());
    r.participants = data.who;
    try {
        auto const s = group_settings(c, function, proportion, settings);
        Hierarchical const h =
            hierarchical_psychometric(data.observers, s, sampler_of(settings, r.parameter + ", " + r.condition));
        fill(r, h, [&](double u) { return level_of(s.shape, u); });
        double const unit = scale_units(c);
        r.deviation = {h.deviation.mean * unit, {h.deviation.low * unit, h.deviation.high * unit}, r.observers};
        r.scale = h.scale.mean * unit;
        r.lapse = h.lapse.mean;
    } catch (std::invalid_argument const& e) {
        r.refused = e.what();
    }
    return r;
}

/// The function of the average observer in a cell, from all procedures.
void add_curve(Block const& b, std::string const& cell, std::vector<RunOf const*> const& runs,
               std::optional<GroupCurve> const& known, AnalysisSettings const& settings, BlockResult& result)
{
    Compare const& c = *b.compare;
    CurveResult r;
    r.cell = cell;
    r.proportion = middle(b.task);
    PsychometricChoice const function = fitted_function(b.procedures, c.scale);
    if (!function.formula) r.scale_unit = scale_units(c);
    r.function = function.name();
    GroupData const data = data_of(runs, r.proportion);
    r.observers = int(data.who.size());
    std::map<double, LevelCount> sums;
    for (ObserverLevels const& o : data.observers)
        for (LevelCount const& l : o.counts) {
            LevelCount& sum = sums[l.level];
            sum = {l.level, sum.correct + l.correct, sum.trials + l.trials};
        }
    std::vector<LevelCount> counts;
    for (auto const& [unused, sum] : sums) counts.push_back(sum);
    if (function.formula) {
        r.counts = counts;
        r.shape = shape_of(c.scale, c.harder_up, function);
        std::vector<std::vector<LevelCount>> people;
        double guess = 0;
        for (ObserverLevels const& o : data.observers) {
            people.push_back(o.counts);
            guess += o.guess / double(data.observers.size());
        }
        fit_pooled(r, b, people, guess, settings);
        result.curves.push_back(std::move(r));
        return;
    }
    std::string note;
    auto const group = known ? known : group_curve(c, function, data, r.proportion, settings, note);
    if (known) {
        append(note, known->threshold.note);
        append(note, data.note);
    }
    if (!group) {
        r.refused = note;
    } else {
        GroupThreshold const& g = group->threshold;
        r.counts = counts;
        r.note = note;
        r.shape = group->settings.shape;
        r.parameters = g.shared;
        r.parameters.threshold = 0;
        double const offset = transformed(r.shape, level_at(r.shape, r.parameters, r.proportion));
        r.parameters.threshold = g.mean - offset;
        r.eta = g.eta;
        r.threshold = level_of(r.shape, g.mean, g.interval, g.observers);
        r.deviation = deviation_of(*group, c);
        r.deviation_interval = deviation_interval_of(*group, c);
        try {
            PsychometricSettings s{r.shape, {r.parameters.guess, data.fits_guess ? 0.5 : 0}, {0.01, 0.06}};
            if (settings.lapse) s.lapse = {*settings.lapse, 0};
            r.pooled = fit_psychometric(counts, s);
        } catch (std::invalid_argument const&) { // one level: no deviance
            r.pooled.deviance = r.pooled.fit_p = kUnknown;
        }
        if (settings.draws > 0 && data.who.size() > 1 && !data.fits_guess)
            result.hierarchical.push_back(hierarchical_of(b, function, cell, data, r.proportion, settings));
    }
    result.curves.push_back(std::move(r));
}

} // namespace

void analyze_thresholds(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
                        std::vector<Group> const& groups, AnalysisSettings const& settings, BlockResult& result)
{
    result.is_log = b.compare->scale != Scale::linear;
    auto all = runs_of(script, b, trials, groups, settings);
    bool const has_many =
        std::any_of(b.procedures.begin(), b.procedures.end(), [](Procedure const& p) { return p.is_many(); });
    std::map<std::string, std::vector<RunOf const*>> cells;
    std::map<std::string, std::optional<GroupCurve>> curves; // of cells with one procedure
    for (auto& [place, runs] : all) {
        Procedure const& p = b.procedures[std::size_t(place.second)];
        if (p.is_many()) { // no curve of one setting: it has parameters
            for (RunOf const& r : runs) result.runs.push_back(r.run);
            continue;
        }
        // Every method at the middle of the rise; staircases also at the proportion to which they converge.
        if (p.method == Method::staircase) add_proportion(b, p, runs, settles_at(p), true, settings, result);
        bool const is_first = !curves.contains(place.first);
        auto group = add_proportion(b, p, runs, middle(b.task), false, settings, result);
        curves[place.first] = is_first && b.procedures.size() == 1 ? std::move(group) : std::nullopt;
        for (RunOf& r : runs) {
            if (p.method == Method::questplus)
                r.run.estimates.push_back(questplus_estimate(r.run, b, p, middle(b.task), settings));
            for (ThresholdEstimate& e : r.run.estimates) note_outside(r.run, e);
            cells[place.first].push_back(&r);
            result.runs.push_back(r.run);
        }
    }
    auto const place = [&](ThresholdRun const& run) {
        return std::find_if(trials.begin(), trials.end(),
                            [&](ObserverTrials const& o) { return o.participant == run.participant; });
    };
    std::stable_sort(result.runs.begin(), result.runs.end(),
                     [&](ThresholdRun const& x, ThresholdRun const& y) { return place(x) < place(y); });
    if (has_many) return;
    for (auto const& [cell, runs] : cells) add_curve(b, cell, runs, curves[cell], settings, result);
}

} // namespace study
