#include "study/plan/plan.h"

#include "study/plan/block_trials.h"
#include "study/plan/counterbalance.h"
#include "study/plan/duration.h"

#include <fmt/format.h>

namespace study {
namespace {

class Planner {
public:
    /// @param broken  blocks left out; those that cannot be planned are added, and why to `m`. Null: throw.
    Planner(Script const& s, int participant, std::vector<bool>* broken, Mistakes* m)
        : s_(s), broken_(broken), mistakes_(m), digits_(digits(s, participant)), passes_(s.blocks.size())
    {
        plan_.participant = participant;
        plan_.participant_id = study::participant_id(s, participant);
    }

    Plan make()
    {
        std::vector<int> levels(s_.factors.size(), -1);
        for (std::size_t i = 0; i < s_.counterbalances.size(); ++i)
            if (s_.counterbalances[i].method == Balance::between)
                levels[std::size_t(s_.counterbalances[i].factor)] = digits_[i];
        walk(s_.sequence, levels);
        return std::move(plan_);
    }

private:
    /// The order of this counterbalance; the same at each use.
    std::vector<int> order_of(std::size_t i) const
    {
        Random random = random_for(s_, plan_.participant, kBalancePurpose + i);
        Counterbalance const& c = s_.counterbalances[i];
        return balanced_order(c.method, item_count(s_, c), digits_[i], random);
    }

    void walk(std::vector<SequenceItem> const& items, std::vector<int> const& levels)
    {
        for (SequenceItem const& item : items) {
            switch (item.kind) {
            case SequenceKind::per:
                walk_per(item, levels);
                break;
            case SequenceKind::block:
                add_block(item.index, levels);
                break;
            case SequenceKind::group:
                for (int const b : order_of(std::size_t(item.index)))
                    add_block(s_.counterbalances[std::size_t(item.index)].blocks[std::size_t(b)], levels);
                break;
            default:
                add_step(item, levels);
            }
        }
    }

    void walk_per(SequenceItem const& item, std::vector<int> levels)
    {
        if (item.index < 0) return walk(item.items, levels); // only in broken scripts
        Random unused(0);
        std::vector<int> order =
            balanced_order(Balance::fixed, int(s_.factors[std::size_t(item.index)].levels.size()), 0, unused);
        for (std::size_t i = 0; i < s_.counterbalances.size(); ++i)
            if (s_.counterbalances[i].factor == item.index) order = order_of(i);
        for (int const level : order) {
            levels[std::size_t(item.index)] = level;
            walk(item.items, levels);
        }
    }

    void add_step(SequenceItem const& item, std::vector<int> levels)
    {
        PlanStep step;
        step.text = item.text;
        step.seconds = item.seconds;
        step.duration_us = std::int64_t(item.seconds * 1e6);
        if (item.kind == SequenceKind::instructions) {
            step.kind = PlanStepKind::instructions;
            step.duration_us = reading_us(item.text);
        } else if (item.kind == SequenceKind::questionnaire) {
            step.kind = PlanStepKind::questionnaire;
            step.questionnaire = item.index;
            step.duration_us = questionnaire_us(s_.questionnaires[std::size_t(item.index)]);
        } else if (item.kind == SequenceKind::rest) {
            step.kind = PlanStepKind::rest;
        } else {
            step.kind = PlanStepKind::free_walk;
            for (LevelChoice const& c : item.choice) levels[std::size_t(c.factor)] = c.level;
            for (LevelChoice const& c : s_.reference)
                if (levels[std::size_t(c.factor)] < 0) levels[std::size_t(c.factor)] = c.level;
        }
        step.levels = levels;
        push(std::move(step));
    }

    void add_block(int index, std::vector<int> const& levels)
    {
        if (broken_ == nullptr) return add_sound_block(index, levels);
        if ((*broken_)[std::size_t(index)]) return;
        if (!mistakes_->attempt([&] { add_sound_block(index, levels); })) (*broken_)[std::size_t(index)] = true;
    }

    void add_sound_block(int index, std::vector<int> const& levels)
    {
        Block const& b = s_.blocks[std::size_t(index)];
        int const pass = passes_[std::size_t(index)]++;
        PlanStep common;
        common.block = index;
        common.pass = pass;
        common.levels = levels;
        if (!b.instructions.empty()) {
            PlanStep step = common;
            step.kind = PlanStepKind::instructions;
            step.text = b.instructions;
            step.duration_us = reading_us(b.instructions);
            push(std::move(step));
        }
        std::uint64_t const purpose = (std::uint64_t(pass) << 32) + std::uint64_t(index);
        std::vector<Trial> const trials = ordered_trials(s_, b, levels, plan_.participant, purpose);
        trial_count_ += trials.size();
        if (trial_count_ > std::size_t(kMostTrials))
            throw ScriptError(s_.file, b.place,
                              fmt::format("more than {} trials up to block '{}'", kMostTrials, b.name),
                              "that is too many for a session", "repeat less");
        int since_break = 0;
        for (std::size_t i = 0; i < trials.size(); ++i) {
            PlanStep step = common;
            step.trial = trials[i];
            step.number = int(i) + 1;
            step.duration_us = trial_us(s_, b, trials[i]);
            step.onset_us = until_onset_us(s_, b);
            push(std::move(step));
            since_break = trials[i].phase == Phase::practice ? 0 : since_break + 1;
            if (b.break_every == 0 || since_break < b.break_every || i + 1 == trials.size()) continue;
            since_break = 0;
            PlanStep rest = common;
            rest.kind = PlanStepKind::rest;
            rest.seconds = b.break_s;
            rest.duration_us = std::int64_t(b.break_s * 1e6);
            push(std::move(rest));
        }
    }

    void push(PlanStep step)
    {
        step.start_us = plan_.duration_us;
        step.onset_us += step.start_us;
        plan_.duration_us += step.duration_us;
        plan_.steps.push_back(std::move(step));
    }

    static constexpr std::uint64_t kBalancePurpose = std::uint64_t(1) << 62;
    Script const& s_;
    std::vector<bool>* broken_;
    Mistakes* mistakes_;
    std::vector<int> digits_, passes_;
    std::size_t trial_count_ = 0;
    Plan plan_;
};

} // namespace

std::string_view name_of(Phase phase)
{
    return phase == Phase::practice ? "practice" : phase == Phase::main ? "main" : "catch";
}

std::string_view name_of(PlanStepKind kind)
{
    constexpr std::string_view kNames[] = {"instructions", "questionnaire", "trial", "break", "free_walk"};
    return kNames[std::size_t(kind)];
}

std::string participant_id(Script const& script, int participant)
{
    std::string const& pattern = script.participants.id;
    auto const open = pattern.find('{'), close = pattern.find('}');
    std::size_t const width = close - open > 3 ? std::size_t(pattern[close - 1] - '0') : 0; // {n:03}
    std::string digits = std::to_string(participant);
    if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
    return pattern.substr(0, open) + digits + pattern.substr(close + 1);
}

int compared_factor(Block const& block)
{
    if (block.pairs) return block.pairs->factor;
    if (block.rank >= 0) return block.rank;
    return block.compare ? block.compare->factor : -1;
}

std::vector<int> levels_of_pairs(Pairs const& pairs)
{
    std::vector<int> levels;
    for (auto const& [a, b] : pairs.pairs) levels.insert(levels.end(), {a, b});
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
}

std::vector<Stimulus> possible_stimuli(Block const& b, Trial const& t)
{
    std::vector<Stimulus> all = t.stimuli;
    if (t.is_open_pair) {
        all.clear();
        for (int const level : levels_of_pairs(*b.pairs)) {
            all.push_back(t.stimuli[0]);
            all.back().levels[std::size_t(b.pairs->factor)] = level;
        }
    }
    if (t.reference) all.push_back(*t.reference);
    return all;
}

Plan make_plan(Script const& script, int participant)
{
    return Planner(script, participant, nullptr, nullptr).make();
}

void find_plan_mistakes(Script const& script, int participants, Mistakes& m,
                        std::function<void(Plan const&)> const& made)
{
    std::vector<bool> broken;
    for (Block const& b : script.blocks) broken.push_back(b.is_broken);
    for (int p = 1; p <= participants; ++p) made(Planner(script, p, &broken, &m).make());
}

} // namespace study
