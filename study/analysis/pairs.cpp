#include "study/analysis/blocks.h"
#include "study/analysis/hierarchical_result.h"
#include "study/numeric/special.h"
#include "study/stats/bootstrap.h"
#include "study/stats/observer_scale.h"
#include "study/stats/outliers.h"
#include "study/stats/triads.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// The levels paired by a block, as items.
std::vector<int> paired_levels(Block const& block)
{
    std::vector<int> levels;
    for (auto const& [a, b] : block.pairs->pairs) levels.insert(levels.end(), {a, b});
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
}

struct Judgement {
    int first = -1, second = -1; ///< items
    double first_wins = 0;       ///< 1, 0, or 1/2 for ties
    bool is_tie = false;
};

class Items {
public:
    explicit Items(Block const& block) : factor_(block.pairs->factor), levels_(paired_levels(block)) {}

    int count() const { return int(levels_.size()); }
    int level(int item) const { return levels_[std::size_t(item)]; }
    int of(Stimulus const& s) const
    {
        auto const it = std::find(levels_.begin(), levels_.end(), s.levels[std::size_t(factor_)]);
        return it == levels_.end() ? -1 : int(it - levels_.begin());
    }
    std::optional<Judgement> choice(TrialRow const& row) const
    {
        std::string order = row.step->trial.order;
        std::erase(order, 'r');
        if (order.size() != 2) return std::nullopt;
        auto const* first = stimulus_of(row.step->trial, order[0]);
        auto const* second = stimulus_of(row.step->trial, order[1]);
        std::string const& answer = row.done->response;
        bool const is_tie = answer == "neither";
        if (first == nullptr || second == nullptr || (!is_tie && answer != "first" && answer != "second"))
            return std::nullopt;
        return Judgement{of(*first), of(*second), is_tie ? 0.5 : answer == "first" ? 1.0 : 0.0, is_tie};
    }

private:
    int factor_;
    std::vector<int> levels_;
};

std::vector<PairCount> counts_of(Items const& items, std::vector<TrialRow> const& rows)
{
    std::vector<PairCount> counts;
    for (TrialRow const& row : rows)
        if (auto const c = items.choice(row))
            counts.push_back({c->first, c->second, c->is_tie ? 0 : c->first_wins,
                              c->is_tie ? 0 : 1 - c->first_wins, c->is_tie ? 1.0 : 0.0});
    return pool({counts});
}

bool has_wins_only(std::vector<ObserverTrials> const& observers)
{
    return std::any_of(observers.begin(), observers.end(),
                       [](ObserverTrials const& o) { return o.detail == TrialDetail::wins; });
}

void add_fit(ScaleResult& r, std::string const& name, PairScale const& fit)
{
    add_fact(r, name + " deviance", fit.deviance);
    add_fact(r, name + " deviance df", double(fit.degrees_of_freedom));
    add_fact(r, name + " deviance p", fit.fit_p);
    if (!fit.note.empty()) add_note(r, name + ": " + fit.note);
}

/// The preference for the first stimulus, tested by the likelihood ratio against a fit without it.
void add_order_effect(ScaleResult& r, std::vector<PairCount> const& pairs, int items, PairScale const& without,
                      TieModel ties)
{
    PairSettings s;
    s.ties = ties;
    PairScale const plain = fit_pairs(pairs, items, s); // on ordered pairs, so that the deviances can be compared
    s.order = OrderEffect::fitted;
    PairScale const with = fit_pairs(pairs, items, s);
    double const drop = std::max(0.0, plain.deviance - with.deviance);
    double moved = 0;
    for (std::size_t i = 0; i < with.score.size(); ++i)
        moved = std::max(moved, std::abs(with.score[i] - without.score[i]) * jod_per_unit(without.model));
    add_fact(r, "order effect JOD", with.order->value * jod_per_unit(with.model));
    add_fact(r, "order effect SE JOD", with.order->standard_error * jod_per_unit(with.model));
    add_fact(r, "order effect p", chi_square_tail(drop, 1));
    add_fact(r, "largest change of a score by it JOD", moved);
}

Uncertain in_jod(Contrast const& c, double jod, int observers)
{
    return {c.value * jod, {c.interval.low * jod, c.interval.high * jod}, observers};
}

/// Scores and differences with errors over observers, or those of the fit if there is only one.
void add_scores(ScaleResult& r, PairScale const& fit, std::optional<ObserverScale> const& over, double confidence)
{
    double const jod = jod_per_unit(fit.model), z = normal_quantile((1 + confidence) / 2);
    auto const of_fit = [&](double value, double error) {
        return Uncertain{value * jod, {(value - z * error) * jod, (value + z * error) * jod}, r.observers};
    };
    for (int a = 0; a < int(r.items.size()); ++a) {
        auto const i = std::size_t(a);
        r.items[i].score = over ? in_jod(score_of(*over, a, confidence), jod, r.observers)
                                : of_fit(fit.score[i], fit.standard_error[i]);
        for (int b = a + 1; b < int(r.items.size()); ++b) {
            if (over) {
                Contrast const c = difference_of(*over, a, b, confidence);
                r.differences.push_back({a, b, in_jod(c, jod, r.observers), c.p});
            } else {
                Difference const d = difference(fit, a, b);
                r.differences.push_back({a, b, of_fit(d.value, d.standard_error), d.p});
            }
        }
    }
}

ScaleResult scale_of_group(Script const& script, std::vector<ObserverTrials> const& trials, Items const& items,
                           int factor, Group const& group, TieModel ties, AnalysisSettings const& settings)
{
    ScaleResult r;
    r.group = group.name;
    r.unit = "JOD";
    std::vector<std::vector<PairCount>> observers;
    for (ObserverTrials const& o : trials)
        if (auto counts = counts_of(items, o.rows); !counts.empty()) observers.push_back(std::move(counts));
    r.observers = int(observers.size());
    bool const is_wins_only = has_wins_only(trials);
    std::vector<PairCount> const pooled = pool(observers);
    Matrix const wins = wins_of(pooled, items.count());
    auto const render = render_times(trials, items.count(), settings.confidence,
                                     [&](TrialRow const&, Stimulus const& s) { return items.of(s); });
    std::vector<std::string> names;
    for (int i = 0; i < items.count(); ++i) {
        ScaledItem item;
        item.name = script.factors[std::size_t(factor)].levels[std::size_t(items.level(i))].name;
        names.push_back(item.name);
        item.render_ms = render[std::size_t(i)];
        r.items.push_back(std::move(item));
        r.wins.emplace_back();
        for (int j = 0; j < items.count(); ++j) r.wins.back().push_back(wins(std::size_t(i), std::size_t(j)));
    }
    for (double const w : wins.values) r.observations += int(std::lround(2 * w));
    r.observations /= 2;
    try {
        if (pooled.empty()) throw std::invalid_argument("no pair was judged");
        check_connected(wins, names);
        PairSettings scaling, logistic;
        scaling.ties = logistic.ties = ties;
        logistic.model = PairModel::bradley_terry;
        std::vector<PairCount> const unordered = without_order(pooled);
        PairScale const fit = fit_pairs(unordered, items.count(), scaling);
        PairScale const other = fit_pairs(unordered, items.count(), logistic);
        std::optional<ObserverScale> over;
        if (observers.size() > 1) {
            std::vector<std::vector<PairCount>> each;
            for (auto const& o : observers) each.push_back(without_order(o));
            over = scale_observers(each, items.count(), scaling);
        } else if (!is_wins_only)
            add_note(r, "one observer: intervals are of the fit, as if all trials were of different people");
        add_scores(r, fit, over, settings.confidence);
        for (std::size_t i = 0; i < r.items.size(); ++i)
            add_fact(r, "Bradley-Terry JOD " + r.items[i].name, other.score[i] * jod_per_unit(other.model));
        if (over) {
            for (std::size_t i = 0; i < r.items.size(); ++i)
                add_fact(r, "bias-reduced JOD " + r.items[i].name,
                         over->reduced.score[i] * jod_per_unit(fit.model));
            add_fact(r, "dispersion over observers", over->dispersion);
            if (settings.has_hierarchy && settings.draws > 0) {
                r.hierarchy = hierarchical_scale(observers, items.count(), settings.confidence,
                                                 sampler_of(settings, "scores, " + group.name));
                if (!r.hierarchy->note.empty()) add_note(r, "hierarchical scale: " + r.hierarchy->note);
            }
        }
        if (fit.tie_threshold) {
            add_fact(r, "threshold of ties JOD", fit.tie_threshold->value * jod_per_unit(fit.model));
            add_fact(r, "threshold of ties SE JOD", fit.tie_threshold->standard_error * jod_per_unit(fit.model));
        }
        add_fit(r, "Thurstone V", fit);
        add_fit(r, "Bradley-Terry", other);
        if (!is_wins_only) add_order_effect(r, pooled, items.count(), fit, ties);
    } catch (std::invalid_argument const& e) {
        r.refused = e.what();
        return r;
    }
    int reference = -1;
    for (LevelChoice const& c : script.reference)
        for (int i = 0; i < items.count() && c.factor == factor; ++i)
            if (items.level(i) == c.level) reference = i;
    judge_differences(r, reference, 1 - settings.confidence);
    return r;
}

/// The first judgement of each pair by each observer in one cell: [i][j] = 1 if i was chosen. Empty if a
/// pair is missing or tied, or its first judgement unknown.
std::optional<Matrix> complete_choices(Items const& items, std::vector<TrialRow> const& rows, TrialDetail detail)
{
    auto const n = std::size_t(items.count());
    Matrix m(n, n, 0);
    for (TrialRow const& row : rows) {
        auto const c = items.choice(row);
        if (!c || c->is_tie) continue;
        auto const i = std::size_t(c->first), j = std::size_t(c->second);
        auto& chosen = c->first_wins > 0 ? m(i, j) : m(j, i);
        if (detail != TrialDetail::trials || m(i, j) + m(j, i) == 0) chosen = 1;
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            if (m(i, j) + m(j, i) != 1) return std::nullopt;
    return m;
}

using Cells = std::map<std::string, std::vector<std::vector<TrialRow>>>; ///< by cell and observer

Cells cells_of_observers(Script const& script, std::vector<ObserverTrials> const& trials,
                         std::vector<Group> const& groups)
{
    Cells cells;
    for (std::size_t o = 0; o < trials.size(); ++o)
        for (TrialRow const& row : trials[o].rows) {
            auto& cell = cells[cell_name(script, groups, row)];
            cell.resize(trials.size());
            cell[o].push_back(row);
        }
    return cells;
}

void add_consistency(Items const& items, Cells const& cells, std::vector<ObserverTrials> const& observers,
                     BlockResult& result, std::vector<ObserverSummary>& summaries)
{
    auto const n = std::size_t(items.count());
    for (auto const& [name, rows] : cells) {
        AgreementResult a;
        a.cell = name;
        Matrix sum(n, n, 0);
        for (std::size_t o = 0; o < rows.size(); ++o) {
            auto const choices = complete_choices(items, rows[o], observers[o].detail);
            if (!choices) {
                ++a.left_out;
                continue;
            }
            ++a.observers;
            for (std::size_t k = 0; k < sum.values.size(); ++k) sum.values[k] += choices->values[k];
            CircularTriads const t = circular_triads(*choices);
            ObserverSummary& s = summaries[o];
            s.triads += t.count;
            s.most_triads += t.maximum;
        }
        try {
            if (a.observers == 0)
                throw std::invalid_argument("no observer has a first choice, known and not a tie, of every pair");
            a.equality = equality_test(sum);
            a.kendall = kendall_u(sum);
        } catch (std::invalid_argument const& e) {
            a.refused = e.what();
        }
        result.agreement.push_back(std::move(a));
    }
    for (ObserverSummary& s : summaries)
        if (s.most_triads > 0) s.zeta = 1 - double(s.triads) / s.most_triads;
}

void add_outliers(Items const& items, Cells const& cells, std::string const& block, std::size_t observers,
                  std::vector<ObserverSummary>& summaries)
{
    std::vector<std::vector<Matrix>> wins;
    for (auto const& [name, rows] : cells) {
        wins.emplace_back();
        for (std::size_t o = 0; o < observers; ++o)
            wins.back().push_back(wins_of(counts_of(items, rows[o]), items.count()));
    }
    try {
        auto const fits = observer_outliers(wins);
        for (std::size_t o = 0; o < observers; ++o)
            if (std::isfinite(fits[o].log_likelihood)) summaries[o].outlier_score[block] = fits[o].outlier_score;
    } catch (std::invalid_argument const&) { // too few observers, or no scale without one of them: no scores
    }
}

} // namespace

void analyze_pairs(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                   AnalysisSettings const& settings, BlockResult& result, std::vector<ObserverSummary>& summaries)
{
    Block const& b = script.blocks[std::size_t(block)];
    Items const items(b);
    auto const groups = groups_of(script, observers, block, {b.pairs->factor});
    for (Group const& g : groups)
        result.scales.push_back(scale_of_group(script, counted(observers, block, g), items, b.pairs->factor, g,
                                               b.may_tie ? TieModel::threshold : TieModel::half_wins, settings));
    auto const cells = cells_of_observers(script, counted(observers, block), groups);
    if (!has_wins_only(observers)) add_consistency(items, cells, observers, result, summaries);
    // An observer without trials in the last cells has rows of length 0 there.
    if (settings.has_outliers && !cells.empty()) add_outliers(items, cells, b.name, observers.size(), summaries);
}

} // namespace study
