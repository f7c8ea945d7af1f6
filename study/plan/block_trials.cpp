#include "study/plan/block_trials.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace study {
namespace {

Stimulus with_choice(Stimulus s, Choice const& choice)
{
    for (LevelChoice const& c : choice) s.levels[std::size_t(c.factor)] = c.level;
    return s;
}

Stimulus with_level(Stimulus s, int factor, int level)
{
    s.levels[std::size_t(factor)] = level;
    return s;
}

/// Trials of one condition, within which presentation orders are balanced.
using Conditions = std::vector<std::vector<std::size_t>>;

/// Each order equally often (within one trial) in every condition and over all of them; the remainder is random.
void assign_orders(std::vector<Trial>& trials, Conditions conditions, std::vector<PresentedOrder> orders,
                   Random& random)
{
    if (orders.empty()) return;
    random.shuffle(orders);
    random.shuffle(conditions);
    std::size_t next = 0;
    for (auto& members : conditions) {
        random.shuffle(members);
        for (std::size_t const i : members) {
            PresentedOrder const& o = orders[next++ % orders.size()];
            trials[i].order = o.letters;
            trials[i].answer = o.answer;
            trials[i].is_noise = o.is_noise;
        }
    }
}

/// Whether the first level of each pair comes first. For all pairs of t levels: the regular tournament, in which
/// each level comes first as often as second (within one). For a list: the level that came first less often.
std::vector<bool> first_comes_first(Pairs const& p)
{
    std::vector<int> levels;
    for (auto const& [a, b] : p.pairs) levels.insert(levels.end(), {a, b});
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    int const t = int(levels.size());
    bool const is_complete = int(p.pairs.size()) == t * (t - 1) / 2;
    auto const rank = [&](int level) {
        return int(std::lower_bound(levels.begin(), levels.end(), level) - levels.begin());
    };
    std::vector<int> surplus(levels.size());
    std::vector<bool> out;
    for (auto const& [a, b] : p.pairs) {
        int const i = rank(a), j = rank(b), distance = (j - i + t) % t;
        bool const first = is_complete ? 2 * distance < t || (2 * distance == t && i < j)
                                       : surplus[std::size_t(i)] <= surplus[std::size_t(j)];
        ++surplus[std::size_t(first ? i : j)];
        --surplus[std::size_t(first ? j : i)];
        out.push_back(first);
    }
    return out;
}

/// Trials whose pairs are chosen when they come; either item comes first equally often (within one) in each cell.
void add_open_pairs(Script const& s, Block const& b, std::vector<std::vector<int>> const& cells, Random& random,
                    std::vector<Trial>& trials)
{
    Pairs const& p = *b.pairs;
    for (std::vector<int> const& levels : cells) {
        Stimulus const cell{levels, false, {}};
        std::vector<std::string> orders;
        for (int i = 0; i < p.active_trials; ++i) orders.emplace_back(i % 2 == 0 ? "ab" : "ba");
        random.shuffle(orders);
        for (std::string const& order : orders) {
            Trial t;
            t.stimuli = {with_level(cell, p.factor, p.pairs[0].first),
                         with_level(cell, p.factor, p.pairs[0].second)};
            if (b.task == Task::pair_with_reference) t.reference = with_choice(cell, s.reference);
            t.order = order;
            t.is_open_pair = true;
            trials.push_back(t);
        }
    }
}

void add_pairs(Script const& s, Block const& b, std::vector<std::vector<int>> const& cells, int participant,
               Random& random, std::vector<Trial>& trials)
{
    Pairs const& p = *b.pairs;
    if (p.is_active()) return add_open_pairs(s, b, cells, random, trials);
    std::vector<bool> const balanced = first_comes_first(p);
    // Thue-Morse sequence: 0 1 1 0 1 0 0 1 ..., one of each in every two participants,
    // not confounded with orders that alternate.
    std::size_t const side = std::size_t(std::popcount(unsigned(participant - 1))) % 2;
    for (int repeat = 0; repeat < b.repeats; ++repeat)
        for (std::size_t c = 0; c < cells.size(); ++c)
            for (std::size_t i = 0; i < p.pairs.size(); ++i) {
                Stimulus const cell{cells[c], false, {}};
                Trial t;
                t.repeat = repeat + 1;
                t.stimuli = {with_level(cell, p.factor, p.pairs[i].first),
                             with_level(cell, p.factor, p.pairs[i].second)};
                if (b.task == Task::pair_with_reference) t.reference = with_choice(cell, s.reference);
                bool const flip = (c + std::size_t(repeat) + side) % 2 == 1;
                bool first = true;
                if (p.order == PairOrder::balanced) first = balanced[i] != flip;
                if (p.order == PairOrder::random) first = random.below(2) == 0;
                t.order = first ? "ab" : "ba";
                trials.push_back(t);
                if (p.order != PairOrder::both) continue;
                t.order = "ba";
                trials.push_back(t);
            }
}

/// Trials whose levels are chosen by procedures.
void add_varied(Block const& b, std::vector<std::vector<int>> const& cells, Random& random,
                std::vector<Trial>& trials)
{
    Conditions steady, adaptive;
    for (std::vector<int> const& cell : cells)
        for (std::size_t k = 0; k < b.procedures.size(); ++k) {
            Procedure const& p = b.procedures[k];
            std::size_t const levels = is_adaptive(p) ? 1 : p.levels.size();
            Conditions by_level(levels), by_run(std::size_t(b.repeats));
            for (int repeat = 0; repeat < b.repeats; ++repeat)
                for (int i = 0; i < planned_trials(p); ++i) {
                    Trial t;
                    t.repeat = repeat + 1;
                    t.procedure = int(k);
                    if (!is_adaptive(p)) t.level = p.levels[std::size_t(i) % levels];
                    Stimulus const base{cell, false, {}};
                    t.stimuli = {Stimulus{cell, true, t.level}, with_choice(base, b.compare->against)};
                    if (b.task == Task::adjustment) {
                        t.order = "a";
                        t.reference = t.stimuli.back();
                        t.stimuli.pop_back();
                    }
                    (is_adaptive(p) ? by_run[std::size_t(repeat)] : by_level[std::size_t(i) % levels])
                        .push_back(trials.size());
                    trials.push_back(t);
                }
            if (is_adaptive(p))
                adaptive.insert(adaptive.end(), by_run.begin(), by_run.end());
            else
                steady.insert(steady.end(), by_level.begin(), by_level.end());
        }
    assign_orders(trials, steady, presented_orders(b.task, false), random);
    assign_orders(trials, adaptive, presented_orders(b.task, true), random);
}

/// Pairs or levels of a factor in tasks that have a correct answer.
void add_judged(Block const& b, std::vector<std::vector<int>> const& cells, Random& random,
                std::vector<Trial>& trials)
{
    Conditions conditions;
    auto const add = [&](Stimulus const& first, Stimulus const& second) {
        conditions.emplace_back();
        for (int repeat = 0; repeat < b.repeats; ++repeat) {
            Trial t;
            t.repeat = repeat + 1;
            t.stimuli = {first, second};
            conditions.back().push_back(trials.size());
            trials.push_back(t);
        }
    };
    for (std::vector<int> const& cell : cells) {
        Stimulus const base{cell, false, {}};
        if (b.pairs)
            for (auto const& [i, j] : b.pairs->pairs)
                add(with_level(base, b.pairs->factor, i), with_level(base, b.pairs->factor, j));
        else
            for (int const level : b.compare->levels) {
                Stimulus varied = with_level(base, b.compare->factor, level);
                varied.is_varied = true;
                add(varied, with_choice(base, b.compare->against));
            }
    }
    assign_orders(trials, conditions, presented_orders(b.task, false), random);
}

/// Trials of conditions shown one at a time, or ranked together.
void add_single(Block const& b, std::vector<std::vector<int>> const& cells, Random& random,
                std::vector<Trial>& trials)
{
    for (int repeat = 0; repeat < b.repeats; ++repeat)
        for (std::vector<int> const& cell : cells) {
            Stimulus const base{cell, false, {}};
            Trial t;
            t.repeat = repeat + 1;
            t.order = "a";
            t.stimuli = {base};
            if (b.magnitude.modulus > 0) t.reference = with_choice(base, b.magnitude.standard);
            if (b.task == Task::ranking) {
                t.stimuli.clear();
                t.order.clear();
                for (int const level : b.rank_levels) {
                    t.order += char('a' + t.stimuli.size());
                    t.stimuli.push_back(with_level(base, b.rank, level));
                }
                random.shuffle(t.order);
            }
            trials.push_back(t);
        }
}

} // namespace

std::vector<std::vector<int>> cells_of(Script const& s, Block const& b, std::vector<int> const& levels)
{
    std::vector<int> base = levels;
    for (LevelChoice const& c : s.reference)
        if (base[std::size_t(c.factor)] < 0) base[std::size_t(c.factor)] = c.level;
    for (std::size_t f = 0; f < b.only.size(); ++f)
        if (b.only[f].size() == 1) base[f] = b.only[f][0];
    std::vector<std::vector<int>> cells{base};
    auto const multiply = [&](int factor, auto const& levels_in) {
        std::vector<std::vector<int>> next;
        for (std::vector<int> const& cell : cells)
            for (int const level : levels_in(cell)) {
                next.push_back(cell);
                next.back()[std::size_t(factor)] = level;
            }
        if (next.size() > std::size_t(kMostTrialsOfBlock))
            throw ScriptError(s.file, b.place,
                              fmt::format("block '{}' has more than {} conditions", b.name, kMostTrialsOfBlock),
                              "that is too many for a session", "cross less");
        cells = std::move(next);
    };
    for (int const f : b.cross) {
        std::vector<int> const all = crossed_levels(s, b, f);
        multiply(f, [&](std::vector<int> const&) -> std::vector<int> const& { return all; });
    }
    for (Nest const& n : b.nest)
        multiply(n.factor, [&](std::vector<int> const& cell) -> std::vector<int> const& {
            return n.levels[std::size_t(cell[std::size_t(n.within)])];
        });
    return cells;
}

std::vector<Trial> main_trials(Script const& s, Block const& b, std::vector<int> const& levels, int participant,
                               Random& random)
{
    auto const cells = cells_of(s, b, levels);
    std::int64_t conditions = 1;
    if (b.pairs) conditions = std::int64_t(b.pairs->pairs.size()) * (b.pairs->order == PairOrder::both ? 2 : 1);
    if (b.pairs && b.pairs->is_active()) conditions = b.pairs->active_trials;
    if (b.compare && b.compare->factor >= 0) conditions = std::int64_t(b.compare->levels.size());
    if (!b.procedures.empty()) conditions = 0;
    for (Procedure const& p : b.procedures) conditions += planned_trials(p);
    std::int64_t const count = std::int64_t(cells.size()) * conditions * b.repeats;
    if (count > kMostTrialsOfBlock)
        throw ScriptError(s.file, b.place, fmt::format("block '{}' has {} trials", b.name, count),
                          fmt::format("at most {} are planned", kMostTrialsOfBlock), "cross or repeat less");
    std::vector<Trial> trials;
    if (!b.procedures.empty())
        add_varied(b, cells, random, trials);
    else if (b.pairs && presented_orders(b.task, false).empty())
        add_pairs(s, b, cells, participant, random, trials);
    else if (b.pairs || b.compare)
        add_judged(b, cells, random, trials);
    else
        add_single(b, cells, random, trials);
    return trials;
}

std::vector<Trial> catch_trials(Script const& s, Block const& b, std::vector<int> const& levels, int count,
                                Random& random)
{
    auto cells = cells_of(s, b, levels);
    random.shuffle(cells);
    std::vector<Trial> trials;
    std::vector<PresentedOrder> orders{{"ab", "first", false}, {"ba", "second", false}};
    if (!b.catches.every) return trials;
    if (b.compare) {
        orders = presented_orders(b.task, b.catches.kind == CatchLevel::number);
        if (b.catches.kind == CatchLevel::absent)
            std::erase_if(orders, [](PresentedOrder const& o) { return !o.is_noise; });
    }
    Conditions all(1);
    for (int i = 0; i < count; ++i) {
        Stimulus const base{cells[std::size_t(i) % cells.size()], false, {}};
        Trial t;
        t.phase = Phase::catches;
        if (b.compare) {
            if (b.catches.kind == CatchLevel::number) t.level = b.catches.level;
            t.stimuli = {Stimulus{base.levels, true, t.level}, with_choice(base, b.compare->against)};
        } else {
            t.stimuli = {with_level(base, b.pairs->factor, b.catches.better),
                         with_level(base, b.pairs->factor, b.catches.worse)};
            if (b.task == Task::pair_with_reference) t.reference = with_choice(base, s.reference);
        }
        all[0].push_back(trials.size());
        trials.push_back(t);
    }
    assign_orders(trials, all, orders, random);
    return trials;
}

} // namespace study
