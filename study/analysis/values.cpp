// Ratings, magnitudes, adjusted levels; rankings.

#include "study/analysis/blocks.h"
#include "study/numeric/special.h"
#include "study/stats/bootstrap.h"
#include "study/stats/rankings.h"
#include "study/stats/ratings.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Combinations of levels of the rated factors, one item each.
class RatedItems {
public:
    RatedItems(Script const& script, Block const& block) : script_(script), factors_(rated_factors(script, block))
    {
    }

    std::vector<int> const& factors() const { return factors_; }
    std::vector<std::string> const& names() const { return names_; }
    /// Items are added when first rated, so that items without ratings are absent.
    int of(Stimulus const& s)
    {
        std::vector<int> key;
        for (int const f : factors_) key.push_back(s.levels[std::size_t(f)]);
        auto const it = std::lower_bound(keys_.begin(), keys_.end(), key);
        auto const at = it - keys_.begin();
        if (it != keys_.end() && *it == key) return int(at);
        keys_.insert(it, key);
        std::string name;
        for (std::size_t i = 0; i < key.size(); ++i)
            name += (i ? " " : "") + script_.factors[std::size_t(factors_[i])].levels[std::size_t(key[i])].name;
        names_.insert(names_.begin() + at, name.empty() ? "all" : name);
        return int(at);
    }
    int reference()
    {
        if (factors_.empty()) return -1;
        std::vector<int> key;
        for (int const f : factors_)
            for (LevelChoice const& c : script_.reference)
                if (c.factor == f) key.push_back(c.level);
        auto const it = std::find(keys_.begin(), keys_.end(), key);
        return it == keys_.end() ? -1 : int(it - keys_.begin());
    }

private:
    Script const& script_;
    std::vector<int> factors_;
    std::vector<std::vector<int>> keys_; ///< sorted: in the order of the script's levels
    std::vector<std::string> names_;
};

bool is_log_axis(Block const& b)
{
    return b.task == Task::magnitude ||
           (b.task == Task::adjustment && b.compare && b.compare->scale != Scale::linear);
}

std::vector<Rating> judgements_of(std::vector<ObserverTrials> const& trials, RatedItems& items, bool is_log)
{
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows) items.of(row.step->trial.stimuli.front());
    std::vector<Rating> judgements;
    for (std::size_t o = 0; o < trials.size(); ++o)
        for (TrialRow const& row : trials[o].rows) {
            if (!row.done->value || (is_log && !(*row.done->value > 0))) continue;
            judgements.push_back({items.of(row.step->trial.stimuli.front()), int(o),
                                  is_log ? std::log(*row.done->value) : *row.done->value});
        }
    return judgements;
}

/// Each observer's mean of each item; NaN = not judged.
Matrix means_of(std::vector<Rating> const& judgements, std::size_t items, std::size_t observers)
{
    Matrix means(items, observers, kUnknown), n(items, observers, 0);
    for (Rating const& r : judgements) {
        auto const item = std::size_t(r.item), observer = std::size_t(r.observer);
        double& m = means(item, observer);
        // Step by step, so that the mean of equal values is exactly that value.
        n(item, observer) += 1;
        m = n(item, observer) == 1 ? r.value : m + (r.value - m) / n(item, observer);
    }
    return means;
}

void add_paired_differences(ScaleResult& r, Matrix const& table, AnalysisSettings const& settings)
{
    for (std::size_t a = 0; a < table.rows; ++a)
        for (std::size_t b = a + 1; b < table.rows; ++b) {
            std::vector<double> differences;
            double size = 0;
            for (std::size_t o = 0; o < table.columns; ++o) {
                differences.push_back(table(a, o) - table(b, o));
                size = std::fmax(size, std::fmax(std::abs(table(a, o)), std::abs(table(b, o))));
            }
            r.differences.push_back(
                {int(a), int(b), mean_of(differences, settings.confidence, size), mean_p(differences, size)});
        }
}

void add_friedman(ScaleResult& r, Matrix const& table)
{
    try {
        Friedman const f = friedman(transposed(table));
        if (f.is_tied) {
            add_note(r, "no Friedman test: no observer ranks any two items differently");
            return;
        }
        add_fact(r, "Friedman chi-square", f.chi_square);
        add_fact(r, "Friedman df", double(f.degrees_of_freedom));
        add_fact(r, "Friedman p", f.p);
        add_fact(r, "Kendall W", f.kendall_w);
        if (f.left_out > 0)
            add_note(r, fmt::format("Friedman's test: {} who did not judge every item {} left out",
                                    f.left_out == 1 ? "1 observer" : fmt::format("{} observers", f.left_out),
                                    f.left_out == 1 ? "is" : "are"));
    } catch (std::invalid_argument const& e) {
        add_note(r, std::string("no Friedman test: ") + e.what());
    }
}

void add_model(ScaleResult& r, std::vector<Rating> const& ratings, int observers)
{
    try {
        RatingModel const m = fit_ratings(ratings, int(r.items.size()), observers);
        for (std::size_t i = 0; i < r.items.size(); ++i)
            add_fact(r, "allowing for bias and inconsistency " + r.items[i].name, m.quality[i]);
        if (!m.note.empty()) add_note(r, "model of raters: " + m.note);
    } catch (std::invalid_argument const& e) {
        add_note(r, std::string("no model of raters: ") + e.what());
    }
}

void add_spread(ScaleResult& r, Block const& b, std::vector<ObserverTrials> const& trials, RatedItems& items)
{
    double const range = std::round((b.scale.high - b.scale.low) / b.scale.step);
    if (!(range >= 1 && range <= 100)) return;
    int const steps = int(range) + 1;
    r.spread.assign(r.items.size(), std::vector<int>(std::size_t(steps), 0));
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows) {
            if (!row.done->value) continue;
            auto const at = std::lround((*row.done->value - b.scale.low) / b.scale.step);
            if (at >= 0 && at < steps)
                ++r.spread[std::size_t(items.of(row.step->trial.stimuli.front()))][std::size_t(at)];
        }
}

ScaleResult values_of_group(Script const& script, Block const& b, std::vector<ObserverTrials> trials,
                            Group const& group, AnalysisSettings const& settings)
{
    ScaleResult r;
    r.group = group.name;
    // Participants who never judged in this group, because they belong to another one, are not missing values.
    std::erase_if(trials, [](ObserverTrials const& o) { return o.rows.empty(); });
    bool const is_log = is_log_axis(b);
    r.unit = b.task == Task::rating ? "rating" : is_log ? "ln(" + std::string(facts(b.task).name) + ")" : "level";
    RatedItems items(script, b);
    std::vector<Rating> const judgements = judgements_of(trials, items, is_log);
    Matrix const table = means_of(judgements, items.names().size(), trials.size());
    for (ObserverTrials const& o : trials) {
        r.observers += o.rows.empty() ? 0 : 1;
        r.observations += int(o.rows.size());
    }
    if (r.observations == 0) {
        r.refused = "there are no judgements";
        return r;
    }
    int const count = int(items.names().size());
    auto const render = render_times(trials, count, settings.confidence,
                                     [&](TrialRow const&, Stimulus const& s) { return items.of(s); });
    auto const opinions = mean_opinions(table, settings.confidence);
    for (int i = 0; i < count; ++i) {
        MeanOpinion const& m = opinions[std::size_t(i)];
        r.items.push_back({items.names()[std::size_t(i)],
                           {m.mean, b.task == Task::rating ? m.skewed : m.interval, m.observers,
                            m.observers > 1 && m.deviation == 0},
                           render[std::size_t(i)]});
    }
    add_paired_differences(r, table, settings);
    note_no_variation(r);
    if (count > 1) add_friedman(r, table);
    if (b.task == Task::rating) {
        if (count > 1 && r.observers > 1) add_model(r, judgements, int(trials.size()));
        add_spread(r, b, trials, items);
    }
    if (r.observers < 2) add_note(r, "one observer: no interval, and no conclusion about others");
    // No adjusted level is better than another.
    if (b.task != Task::adjustment) judge_differences(r, items.reference(), 1 - settings.confidence);
    return r;
}

struct Ranked {
    std::vector<std::vector<std::vector<int>>> rankings; ///< by observer: items, best first
    int count = 0;
};

Ranked rankings_of(Block const& b, std::vector<ObserverTrials> const& trials)
{
    Ranked out;
    for (ObserverTrials const& o : trials) {
        std::vector<std::vector<int>> theirs;
        for (TrialRow const& row : o.rows) {
            std::vector<int> ranking;
            for (char const letter : row.done->response)
                if (Stimulus const* s = stimulus_of(row.step->trial, letter)) {
                    auto const at =
                        std::find(b.rank_levels.begin(), b.rank_levels.end(), s->levels[std::size_t(b.rank)]);
                    if (at != b.rank_levels.end()) ranking.push_back(int(at - b.rank_levels.begin()));
                }
            if (ranking.size() > 1) theirs.push_back(std::move(ranking));
        }
        out.count += int(theirs.size());
        if (!theirs.empty()) out.rankings.push_back(std::move(theirs));
    }
    return out;
}

std::vector<double> utilities(Ranked const& ranked, std::vector<int> const& observers, int items,
                              std::string* note)
{
    std::vector<ChoiceAmong> choices;
    for (int const o : observers)
        for (auto const& ranking : ranked.rankings[std::size_t(o)])
            for (ChoiceAmong& c : choices_of(ranking)) choices.push_back(std::move(c));
    auto const fit = fit_plackett_luce(choices, items);
    if (note) *note = fit.note;
    return fit.score;
}

ScaleResult ranking_of_group(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
                             Group const& group, AnalysisSettings const& settings)
{
    ScaleResult r;
    r.group = group.name;
    r.unit = "utility";
    Ranked const ranked = rankings_of(b, trials);
    r.observers = int(ranked.rankings.size());
    r.observations = ranked.count;
    auto const n = b.rank_levels.size();
    auto const item_of = [&](Stimulus const& s) {
        auto const at = std::find(b.rank_levels.begin(), b.rank_levels.end(), s.levels[std::size_t(b.rank)]);
        return at == b.rank_levels.end() ? -1 : int(at - b.rank_levels.begin());
    };
    auto const render = render_times(trials, int(n), settings.confidence,
                                     [&](TrialRow const&, Stimulus const& s) { return item_of(s); });
    for (std::size_t i = 0; i < n; ++i)
        r.items.push_back(
            {script.factors[std::size_t(b.rank)].levels[std::size_t(b.rank_levels[i])].name, {}, render[i]});
    try {
        if (ranked.rankings.empty()) throw std::invalid_argument("there are no rankings");
        std::vector<int> all(ranked.rankings.size());
        for (std::size_t o = 0; o < all.size(); ++o) all[o] = int(o);
        std::string note;
        std::vector<double> const score = utilities(ranked, all, int(n), &note);
        if (!note.empty()) add_note(r, note);
        std::optional<Bootstrap> boot;
        try {
            boot = bootstrap(r.observers,
                             [&](std::span<int const> drawn) {
                                 return utilities(ranked, {drawn.begin(), drawn.end()}, int(n), nullptr);
                             },
                             {settings.replicates, settings.confidence, settings.seed});
        } catch (std::invalid_argument const& e) {
            add_note(r, std::string("no intervals: ") + e.what());
        }
        for (std::size_t i = 0; i < n; ++i)
            r.items[i].score = {score[i], boot ? boot->interval[i] : Interval{kUnknown, kUnknown}, r.observers};
        // Mean ranks of each observer, larger = better, for tests over observers.
        Matrix ranks(n, ranked.rankings.size(), 0), times = ranks;
        for (std::size_t o = 0; o < ranked.rankings.size(); ++o)
            for (auto const& ranking : ranked.rankings[o])
                for (std::size_t place = 0; place < ranking.size(); ++place) {
                    ranks(std::size_t(ranking[place]), o) += double(n - place);
                    times(std::size_t(ranking[place]), o) += 1;
                }
        for (std::size_t k = 0; k < ranks.values.size(); ++k)
            ranks.values[k] = times.values[k] > 0 ? ranks.values[k] / times.values[k] : kUnknown;
        if (boot)
            for (ScaledItem& i : r.items)
                i.score.is_constant = r.observers > 1 && std::isnan(i.score.interval.low);
        add_paired_differences(r, ranks, settings);
        note_no_variation(r);
        add_friedman(r, ranks);
        for (std::size_t i = 0; i < n; ++i) {
            double sum = 0;
            for (std::size_t o = 0; o < ranks.columns; ++o) sum += double(n) + 1 - ranks(i, o);
            add_fact(r, "mean rank " + r.items[i].name, sum / double(ranks.columns));
        }
        add_note(r, "differences and their tests use the ranks of each observer, 1 = one place better");
    } catch (std::invalid_argument const& e) {
        r.refused = e.what();
        return r;
    }
    int reference = -1;
    for (LevelChoice const& c : script.reference)
        for (std::size_t i = 0; i < n && c.factor == b.rank; ++i)
            if (b.rank_levels[i] == c.level) reference = int(i);
    judge_differences(r, reference, 1 - settings.confidence);
    return r;
}

} // namespace

void analyze_values(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                    AnalysisSettings const& settings, BlockResult& result)
{
    Block const& b = script.blocks[std::size_t(block)];
    result.is_log = is_log_axis(b);
    for (Group const& g : groups_of(script, observers, block, rated_factors(script, b)))
        result.scales.push_back(values_of_group(script, b, counted(observers, block, g), g, settings));
}

void analyze_rankings(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                      AnalysisSettings const& settings, BlockResult& result)
{
    Block const& b = script.blocks[std::size_t(block)];
    for (Group const& g : groups_of(script, observers, block, {b.rank}))
        result.scales.push_back(ranking_of_group(script, b, counted(observers, block, g), g, settings));
}

} // namespace study
