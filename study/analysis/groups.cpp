#include "study/analysis/groups.h"

#include "study/numeric/rounding.h"
#include "study/numeric/special.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace study {

std::vector<Group> groups_of(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                             std::vector<int> const& items_of)
{
    std::vector<Group> groups{{"all", -1, -1}};
    for (std::size_t f = 0; f < script.factors.size(); ++f) {
        if (std::find(items_of.begin(), items_of.end(), int(f)) != items_of.end()) continue;
        std::set<int> levels;
        for (ObserverTrials const& o : observers)
            for (TrialRow const& row : o.rows)
                if (row.step->block == block && row.status == TrialStatus::counted)
                    levels.insert(shared_level(*row.block, row.step->trial, int(f)));
        if (levels.size() < 2) continue;
        for (int const level : levels)
            groups.push_back(
                {script.factors[f].name + "=" + script.factors[f].levels[std::size_t(level)].name, int(f), level});
    }
    return groups;
}

std::string cell_name(Script const& script, std::vector<Group> const& groups, TrialRow const& row)
{
    std::string name;
    int last = -1;
    for (Group const& g : groups) {
        if (g.factor < 0 || g.factor == last) continue;
        last = g.factor;
        int const level = shared_level(*row.block, row.step->trial, g.factor);
        Factor const& f = script.factors[std::size_t(g.factor)];
        name += (name.empty() ? "" : " ") + f.name + "=" + f.levels[std::size_t(level)].name;
    }
    return name.empty() ? "all" : name;
}

std::vector<ObserverTrials> counted(std::vector<ObserverTrials> const& observers, int block, Group const& group)
{
    std::vector<ObserverTrials> out;
    for (ObserverTrials const& o : observers) {
        out.push_back({o.participant, {}, o.detail});
        for (TrialRow const& row : o.rows)
            if (row.step->block == block && row.status == TrialStatus::counted && group.has(row))
                out.back().rows.push_back(row);
    }
    return out;
}

std::map<double, std::string> level_names(std::vector<ObserverTrials> const& trials)
{
    std::map<double, std::string> names;
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows)
            if (row.done->level) names[*row.done->level];
    constexpr int kLeastDigits = 6, kMostDigits = 17;
    for (int digits = kLeastDigits; digits <= kMostDigits; ++digits) {
        std::set<std::string> texts;
        for (auto& [level, name] : names) texts.insert(name = fmt::format("{:.{}g}", level, digits));
        if (texts.size() == names.size()) break;
    }
    return names;
}

std::vector<int> rated_factors(Script const& script, Block const& block)
{
    std::vector<int> factors;
    for (LevelChoice const& c : script.reference)
        if (std::find(block.cross.begin(), block.cross.end(), c.factor) != block.cross.end())
            factors.push_back(c.factor);
    if (factors.empty() && !block.cross.empty()) factors.push_back(block.cross.back());
    return factors;
}

std::vector<Uncertain> render_times(std::vector<ObserverTrials> const& observers, int items, double confidence,
                                    std::function<int(TrialRow const&, Stimulus const&)> const& item)
{
    std::vector<std::vector<double>> means(std::size_t(items), std::vector<double>{});
    for (ObserverTrials const& o : observers) {
        std::vector<double> sum(std::size_t(items), 0), frames(std::size_t(items), 0);
        for (TrialRow const& row : o.rows)
            for (StimulusShown const& s : row.done->shown) {
                Stimulus const* const stimulus = stimulus_of(row.step->trial, s.letter);
                int const i = stimulus ? item(row, *stimulus) : -1;
                if (i < 0 || !(s.render_ms_mean > 0)) continue;
                double const weight = std::max(1, s.frames_shown);
                sum[std::size_t(i)] += weight * s.render_ms_mean;
                frames[std::size_t(i)] += weight;
            }
        for (std::size_t i = 0; i < means.size(); ++i)
            if (frames[i] > 0) means[i].push_back(sum[i] / frames[i]);
    }
    std::vector<Uncertain> out;
    for (auto const& m : means) out.push_back(mean_of(m, confidence));
    return out;
}

namespace {

std::vector<double> known_of(std::vector<double> const& values)
{
    std::vector<double> known;
    std::copy_if(values.begin(), values.end(), std::back_inserter(known),
                 [](double v) { return std::isfinite(v); });
    return known;
}

} // namespace

Uncertain mean_of(std::vector<double> const& values, double confidence, double size)
{
    std::vector<double> const known = known_of(values);
    Uncertain u;
    u.n = int(known.size());
    if (known.empty()) return u;
    u.value = without_rounding(mean(known), std::max(size, largest_of(known)));
    if (known.size() < 2) return u;
    double const sd = standard_deviation(known, size);
    u.is_constant = sd == 0;
    if (u.is_constant) return u;
    double const half =
        student_quantile((1 + confidence) / 2, double(known.size() - 1)) * sd / std::sqrt(double(known.size()));
    u.interval = {u.value - half, u.value + half};
    return u;
}

double mean_p(std::vector<double> const& values, double size)
{
    std::vector<double> const known = known_of(values);
    if (known.size() < 2) return kUnknown;
    double const error = standard_deviation(known, size) / std::sqrt(double(known.size()));
    if (!(error > 0)) return kUnknown;
    return 2 * student_cdf(-std::abs(mean(known) / error), double(known.size() - 1));
}

std::vector<double> holm(std::vector<double> const& p)
{
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!std::isnan(p[i])) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> out(p.size(), kUnknown);
    double most = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        most = std::max(most, std::min(1.0, double(order.size() - k) * p[order[k]]));
        out[order[k]] = most;
    }
    return out;
}

void judge_differences(ScaleResult& scale, int reference, double level)
{
    std::vector<double> p;
    for (ItemDifference const& d : scale.differences) p.push_back(d.p);
    std::vector<double> const adjusted = holm(p);
    for (std::size_t i = 0; i < adjusted.size(); ++i) scale.differences[i].p_holm = adjusted[i];

    Cheapest best;
    best.is_reference = reference >= 0;
    best.against = reference;
    for (std::size_t i = 0; i < scale.items.size() && reference < 0; ++i)
        if (best.against < 0 || scale.items[i].score.value > scale.items[std::size_t(best.against)].score.value)
            best.against = int(i);
    if (best.against < 0) return;
    for (std::size_t i = 0; i < scale.items.size(); ++i) {
        double const cost = scale.items[i].render_ms.value;
        if (!(cost > 0)) continue;
        bool const is_cheaper = best.item < 0 || cost < scale.items[std::size_t(best.item)].render_ms.value;
        if (!is_cheaper) continue;
        if (int(i) == best.against) {
            best.item = int(i);
            best.difference = {0, {0, 0}, scale.observers};
            best.p_holm = 1;
            continue;
        }
        for (ItemDifference const& d : scale.differences) {
            bool const straight = d.a == int(i) && d.b == best.against,
                       turned = d.b == int(i) && d.a == best.against;
            // Only items that are significantly worse than the best are refused: better ones are fine.
            double const value = turned ? -d.value.value : d.value.value;
            bool const is_worse =
                d.value.is_constant ? value < 0 : std::isnan(d.p_holm) || (d.p_holm < level && value < 0);
            if ((!straight && !turned) || is_worse) continue;
            best.item = int(i);
            best.difference = turned ? Uncertain{-d.value.value,
                                                 {-d.value.interval.high, -d.value.interval.low},
                                                 d.value.n,
                                                 d.value.is_constant}
                                     : d.value;
            best.p_holm = d.p_holm;
        }
    }
    if (best.item >= 0) scale.cheapest = best;
}

void note_no_variation(ScaleResult& scale)
{
    constexpr std::size_t kMostNamed = 6;
    auto const say = [&](std::vector<std::string> names, char const* what) {
        if (names.empty()) return;
        std::size_t const more = names.size() > kMostNamed ? names.size() - kMostNamed : 0;
        names.resize(names.size() - more);
        add_note(scale, fmt::format("no variation between observers in {}{}: {}", fmt::join(names, ", "),
                                    more > 0 ? fmt::format(" and {} others", more) : "", what));
    };
    std::vector<std::string> items, differences;
    for (ScaledItem const& i : scale.items)
        if (i.score.is_constant) items.push_back(i.name);
    for (ItemDifference const& d : scale.differences)
        if (d.value.is_constant)
            differences.push_back(
                fmt::format("{} - {}", scale.items[std::size_t(d.a)].name, scale.items[std::size_t(d.b)].name));
    say(items, "no interval");
    say(differences, "no interval and no test, all observers differ by the same");
}

void add_fact(ScaleResult& scale, std::string_view name, double value)
{
    bool const is_fitted = name.find("JOD") != std::string_view::npos;
    scale.facts.push_back({std::string(name), is_fitted ? without_noise(value) : value});
}

void add_note(ScaleResult& scale, std::string_view text) { scale.notes.emplace_back(text); }

} // namespace study
