#include "study/plan/arrange.h"
#include "study/plan/block_trials.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

std::vector<int> tokens_of(Script const& s, Block const& b, Trial const& t, Constraint const& c)
{
    Stimulus const& a = t.stimuli[0];
    switch (c.subject) {
    case Subject::pair:
        if (!b.pairs) return {a.levels[std::size_t(b.compare->factor)]};
        {
            auto const [low, high] = std::minmax(a.levels[std::size_t(b.pairs->factor)],
                                                 t.stimuli[1].levels[std::size_t(b.pairs->factor)]);
            return {low * int(s.factors[std::size_t(b.pairs->factor)].levels.size()) + high};
        }
    case Subject::answer: {
        if (t.answer.empty()) return {};
        auto const& answers = facts(b.task).answers;
        return {int(std::find(answers.begin(), answers.end(), t.answer) - answers.begin())};
    }
    case Subject::procedure:
        if (t.procedure < 0) return {};
        return {t.procedure};
    case Subject::factor:
        break;
    }
    std::vector<int> tokens{a.levels[std::size_t(c.factor)]};
    if (b.pairs && b.pairs->factor == c.factor) tokens.push_back(t.stimuli[1].levels[std::size_t(c.factor)]);
    return tokens;
}

/// Orders trials; those of a group (a repeat, catch trials, ...) stay in the group's places.
std::vector<Trial> in_order(Script const& s, Block const& b, std::vector<Trial> const& trials,
                            std::vector<int> const& group_of_trial, std::vector<int> const& group_of_place,
                            Random& random)
{
    std::vector<ArrangeItem> items;
    std::vector<ArrangeRule> rules;
    for (Constraint const& c : b.constraints) rules.push_back({c.kind, c.count, c.from, c.to});
    for (std::size_t i = 0; i < trials.size(); ++i) {
        items.push_back({{}, group_of_trial[i]});
        for (Constraint const& c : b.constraints) items.back().tokens.push_back(tokens_of(s, b, trials[i], c));
    }
    std::vector<int> order;
    try {
        order = arrange(items, rules, group_of_place, random);
    } catch (NoOrder const& e) {
        throw ScriptError(s.file, b.constraints.empty() ? b.place : b.constraints[0].place,
                          fmt::format("the constraints of block '{}' cannot be satisfied", b.name), e.what(),
                          "relax them, or change how often each condition occurs");
    }
    if (find_broken(items, rules, order)) throw std::logic_error("an arranged order breaks a rule");
    std::vector<Trial> out;
    for (int const i : order) out.push_back(trials[std::size_t(i)]);
    return out;
}

/// Groups within which `shuffle` orders trials.
std::vector<int> groups_of(Block const& b, std::vector<Trial> const& trials)
{
    std::vector<int> groups;
    for (std::size_t i = 0; i < trials.size(); ++i)
        groups.push_back(b.shuffle == Shuffle::all              ? 0
                         : b.shuffle == Shuffle::within_repeats ? trials[i].repeat - 1
                                                                : int(i));
    return groups;
}

/// The listed order, repeat after repeat.
std::vector<Trial> listed(Script const& s, Block const& b, std::vector<int> const& levels, int participant,
                          Random& random)
{
    std::vector<Trial> trials = main_trials(s, b, levels, participant, random);
    std::stable_sort(trials.begin(), trials.end(),
                     [](Trial const& x, Trial const& y) { return x.repeat < y.repeat; });
    return trials;
}

std::vector<Trial> practice_of(Script const& s, Block const& b, std::vector<int> const& levels, int participant,
                               Random& random)
{
    std::vector<Trial> trials = listed(s, b, levels, participant, random);
    if (b.practice.trials > int(trials.size()))
        throw ScriptError(
            s.file, b.place,
            fmt::format("block '{}' practises {} of its {} trials", b.name, b.practice.trials, trials.size()),
            "practice uses the first trials of a separate order", "practise fewer");
    std::vector<int> const groups = groups_of(b, trials);
    trials = in_order(s, b, trials, groups, groups, random);
    trials.resize(std::size_t(b.practice.trials));
    for (Trial& t : trials) {
        t.phase = Phase::practice;
        if (t.is_open_pair) { // practice is planned
            auto const& pairs = b.pairs->pairs;
            auto const [first, second] = pairs[random.below(std::uint32_t(pairs.size()))];
            t.stimuli[0].levels[std::size_t(b.pairs->factor)] = first;
            t.stimuli[1].levels[std::size_t(b.pairs->factor)] = second;
            t.is_open_pair = false;
        }
        if (b.procedures.empty()) continue;
        t.procedure = -1;
        t.level = b.practice.level.value_or(easiest(*b.compare));
        t.stimuli[0].level = t.level;
    }
    return trials;
}

} // namespace

Random random_for(Script const& script, int participant, std::uint64_t purpose)
{
    Random person = Random::part(script.seed, std::uint64_t(participant));
    std::uint64_t const high = person.next();
    return Random::part((high << 32) | person.next(), purpose);
}

std::vector<Trial> ordered_trials(Script const& s, Block const& b, std::vector<int> const& levels, int participant,
                                  std::uint64_t purpose)
{
    constexpr int kCatchGroup = -1;
    Random random = random_for(s, participant, 2 * purpose);
    std::vector<Trial> trials = listed(s, b, levels, participant, random);
    std::vector<int> groups = groups_of(b, trials);
    std::vector<int> places = groups;
    if (b.catches.every > 0) {
        int const every = b.catches.every, count = int(trials.size()) / every;
        if (count == 0)
            throw ScriptError(
                s.file, b.catches.place,
                fmt::format("a catch trial every {} of the {} trials of block '{}'", every, trials.size(), b.name),
                "there would be no catch trial", "write a smaller number");
        for (Trial const& t : catch_trials(s, b, levels, count, random)) {
            trials.push_back(t);
            groups.push_back(kCatchGroup);
        }
        for (int i = 0; i < count; ++i) // after one of the trials of each stretch, never first
            places.insert(places.begin() + i * (every + 1) + 1 + int(random.below(std::uint32_t(every))),
                          kCatchGroup);
    }
    trials = in_order(s, b, trials, groups, places, random);
    if (b.practice.trials == 0) return trials;
    Random other = random_for(s, participant, 2 * purpose + 1);
    std::vector<Trial> all = practice_of(s, b, levels, participant, other);
    all.insert(all.end(), trials.begin(), trials.end());
    return all;
}

} // namespace study
