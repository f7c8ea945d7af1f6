#include "study/plan/doubts.h"

#include "gi/core/text.h"
#include "study/plan/counterbalance.h"
#include "study/plan/duration.h"
#include "study/plan/plan_text.h"
#include "study/script/condition.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

/// True for QUEST+ if the function never falls to a half, where the threshold is,
/// because all guess rates are >= 0.5.
bool never_reaches_half(Block const& b, Procedure const& p)
{
    bool const goes_to_false_alarms = b.task == Task::yes_no || b.task == Task::same_different;
    return goes_to_false_alarms && p.method == Method::questplus &&
           std::all_of(p.guess.begin(), p.guess.end(), [](double guess) { return guess >= 0.5; });
}

/// True if the task's proportion correct by guessing is known and lies beside the grid of `guess`.
bool misses_guess_rate(Task task, Procedure const& p)
{
    constexpr double kNear = 0.02;
    double const rate = guess_rate(task);
    return rate > 0 && (rate < p.guess.front() - kNear || rate > p.guess.back() + kNear);
}

std::string range_text(std::vector<double> const& grid)
{
    return grid.size() == 1 ? fmt::format("{:g}", grid[0])
                            : fmt::format("{:g} to {:g}", grid.front(), grid.back());
}

/// Equal if the renderer gets the same: without prefixes, numbers as numbers.
std::map<std::string, std::string> plain(Patch const& patch)
{
    std::map<std::string, std::string> out;
    for (auto const& [key, value] : patch) {
        auto const number = gi::parse_finite(value);
        out[plain_key(key)] = number ? level_text(*number) : value;
    }
    return out;
}

void find_equal_levels(Factor const& f, std::vector<std::string>& doubts)
{
    std::map<std::map<std::string, std::string>, std::string> seen;
    for (FactorLevel const& level : f.levels) {
        if (level.settings.empty()) continue;
        auto const [first, is_new] = seen.emplace(plain(level.settings), level.name);
        if (!is_new)
            doubts.push_back(
                fmt::format("levels '{}' and '{}' of factor '{}' have the same settings: their stimuli "
                            "are alike",
                            first->second, level.name, f.name));
    }
}

/// True if one factor tells the level of the other. Cameras are those of scenes: they cannot be crossed with them.
bool is_confounded(Nest const& n, Factor const& nested)
{
    bool const are_cameras = std::ranges::all_of(nested.levels, [](FactorLevel const& level) {
        return !level.settings.empty() && std::ranges::all_of(level.settings, [](auto const& one) {
            return plain_key(one.first).starts_with("camera");
        });
    });
    if (are_cameras) return false;
    std::vector<int> inner;
    for (std::vector<int> const& levels : n.levels) {
        if (levels.size() > 1) return false;
        inner.insert(inner.end(), levels.begin(), levels.end());
    }
    std::ranges::sort(inner);
    return inner.size() > 1 && std::ranges::adjacent_find(inner) == inner.end();
}

} // namespace

std::vector<std::string> find_idle_procedures(Script const& s)
{
    std::vector<std::string> found;
    for (Block const& b : s.blocks)
        for (Procedure const& p : b.procedures) {
            std::string const who = fmt::format("block '{}': procedure '{}'", b.name, p.name);
            if (p.method == Method::questplus && p.has_one_point())
                found.push_back(
                    fmt::format("{} has a prior of one point: no answer can change it, it learns nothing "
                                "and always presents the same level; give threshold several values, such "
                                "as 20..100/17",
                                who));
            else if (p.method == Method::questplus && p.threshold.size() == 1 && !p.is_many())
                found.push_back(fmt::format("{} has a prior with one threshold, {:g}: it learns nothing of the "
                                            "threshold; give it several values, such as 20..100/17",
                                            who, p.threshold[0]));
            if (p.method != Method::staircase || !b.compare || p.steps.empty()) continue;
            int const fewest = p.stop.reversals * (p.up + p.down) / 2;
            if (p.stop.trials > 0 && p.stop.trials < fewest)
                found.push_back(
                    fmt::format("{} ends after {} trials, before {} reversals are possible ({} trials at least)",
                                who, p.stop.trials, p.stop.reversals, fewest));
            double const width =
                to_scale(b.compare->scale, b.compare->high) - to_scale(b.compare->scale, b.compare->low);
            if (p.steps.back() >= width)
                found.push_back(
                    fmt::format("{} ends with steps of {:g} in a range that is {:g} wide: it only moves "
                                "between the ends and learns nothing else; make the last step smaller",
                                who, p.steps.back(), width));
        }
    return found;
}

std::vector<std::string> find_doubts(Script const& s)
{
    std::vector<std::string> doubts;
    std::int64_t const cycle = full_cycle(s);
    if (s.participants.count % cycle != 0)
        doubts.push_back(
            fmt::format("{} participants do not have all {} combinations of orders equally often; a multiple "
                        "of {} would",
                        s.participants.count, cycle, cycle));
    for (Factor const& f : s.factors) find_equal_levels(f, doubts);
    for (Block const& b : s.blocks)
        for (Nest const& n : b.nest)
            if (is_confounded(n, s.factors[std::size_t(n.factor)]))
                doubts.push_back(fmt::format(
                    "block '{}': each level of '{}' has its own level of '{}': what they change cannot "
                    "be told apart; cross them",
                    b.name, s.factors[std::size_t(n.within)].name, s.factors[std::size_t(n.factor)].name));
    for (Block const& b : s.blocks) {
        if (!b.pairs || !b.pairs->is_active()) continue;
        std::size_t const levels = levels_of_pairs(*b.pairs).size();
        if (std::size_t(b.pairs->active_trials) + 1 < levels)
            doubts.push_back(
                fmt::format("block '{}': {} active trials cannot connect {} levels; at least {} would", b.name,
                            b.pairs->active_trials, levels, levels - 1));
    }
    for (Block const& b : s.blocks)
        for (Procedure const& p : b.procedures)
            if (never_reaches_half(b, p))
                doubts.push_back(fmt::format("block '{}': guess of procedure '{}' is 0.5 or more; in {} it is the "
                                             "false alarm rate, and "
                                             "the threshold, where half of the answers are {}, is never reached; "
                                             "use for example guess: [0, 0.1, 0.2]",
                                             b.name, p.name, facts(b.task).name,
                                             b.task == Task::yes_no ? "yes" : "different"));
    for (Block const& b : s.blocks)
        for (Procedure const& p : b.procedures)
            if (p.method == Method::questplus && misses_guess_rate(b.task, p))
                doubts.push_back(
                    fmt::format("block '{}': guess of procedure '{}' is {}, but guessing gives {:.3g} "
                                "in {}: thresholds would be wrong; write guess: {:.3g}",
                                b.name, p.name, range_text(p.guess), guess_rate(b.task), facts(b.task).name,
                                guess_rate(b.task)));
    for (std::string& idle : find_idle_procedures(s)) doubts.push_back(std::move(idle));
    for (Block const& b : s.blocks)
        if (b.gaze.any() && s.record.gaze.empty())
            doubts.push_back(
                fmt::format("block '{}' has rules of gaze, but record.gaze names no source: study run "
                            "needs --gaze",
                            b.name));
    for (Block const& b : s.blocks) {
        std::size_t const orders = presented_orders(b.task, false).size();
        if (orders == 0 || !b.procedures.empty() || std::size_t(b.repeats) % orders == 0) continue;
        doubts.push_back(
            fmt::format("block '{}': the {} orders of presentation are balanced over all trials, but not "
                        "within each condition; repeats: {} balances them",
                        b.name, orders, (std::size_t(b.repeats) / orders + 1) * orders));
    }
    return doubts;
}

std::vector<std::string> find_doubts(Script const& s, Plan const& plan)
{
    constexpr std::int64_t kLongStretch_us = 20LL * 60 * 1000000;
    std::vector<std::string> doubts;
    if (plan.duration_us > kLongSession_us)
        doubts.push_back(
            fmt::format("the session is expected to take {}: people tire after about 60 minutes; repeat "
                        "less, or make two sessions of it",
                        clock_text(plan.duration_us)));
    std::int64_t stretch = 0, longest = 0;
    int where = -1;
    for (PlanStep const& step : plan.steps) {
        stretch = step.kind == PlanStepKind::trial ? stretch + step.duration_us : 0;
        if (stretch <= longest) continue;
        longest = stretch;
        where = step.block;
    }
    if (longest > kLongStretch_us)
        doubts.push_back(fmt::format("{} of trials without a break, up to block '{}'; add breaks with break_every",
                                     clock_text(longest), s.blocks[std::size_t(where)].name));
    return doubts;
}

} // namespace study
