#include "study/plan/plan_text.h"

#include "gi/core/text.h"
#include "study/plan/counterbalance.h"
#include "study/plan/transitions.h"

#include <fmt/format.h>
#include <map>

namespace study {
namespace {

std::string fixed_levels(Script const& s, std::vector<int> const& levels)
{
    std::string text;
    for (std::size_t f = 0; f < levels.size(); ++f)
        if (levels[f] >= 0)
            text += (text.empty() ? "" : ", ") + s.factors[f].name + " " +
                    s.factors[f].levels[std::size_t(levels[f])].name;
    return text;
}

std::string first_line(std::string const& text) { return gi::shortened(text.substr(0, text.find('\n')), 70); }

/// Names of the trial's levels of the crossed and nested factors.
std::string cell_text(Script const& s, Block const& b, Trial const& t)
{
    std::string text;
    auto const add = [&](int f) {
        text += (text.empty() ? "" : " ") +
                s.factors[std::size_t(f)].levels[std::size_t(t.stimuli[0].levels[std::size_t(f)])].name;
    };
    for (int const f : b.cross) add(f);
    for (Nest const& n : b.nest) add(n.factor);
    return text;
}

std::string trial_text(Script const& s, PlanStep const& step)
{
    Block const& b = s.blocks[std::size_t(step.block)];
    Trial const& t = step.trial;
    std::string text = fmt::format("{:>6} {:<8} {}", step.number, name_of(t.phase), cell_text(s, b, t));
    if (t.stimuli.size() > 1 || b.compare) {
        if (text.back() != ' ') text += ": ";
        if (t.is_open_pair) return text + "pair chosen then, " + t.order;
        for (char const letter : t.order) text += stimulus_label(s, b, t.stimuli[std::size_t(letter - 'a')]) + " ";
        text.pop_back();
    }
    if (t.procedure >= 0) text += " by " + b.procedures[std::size_t(t.procedure)].name;
    if (t.level) text += " at " + level_text(*t.level);
    if (!t.answer.empty()) text += " -> " + t.answer;
    return text;
}

/// "scene: arches 10, atrium 10": counts of main and catch trials of a pass. For pairs:
/// how often shown, and how often first.
std::string condition_counts(Script const& s, Plan const& plan, int block, int pass)
{
    Block const& b = s.blocks[std::size_t(block)];
    std::vector<std::map<int, std::pair<int, int>>> levels(s.factors.size()); // level: shown, shown first
    std::map<std::string, int> answers;
    for (PlanStep const& step : plan.steps) {
        if (step.kind != PlanStepKind::trial || step.block != block || step.pass != pass) continue;
        Trial const& t = step.trial;
        if (t.phase == Phase::practice) continue;
        if (!t.answer.empty()) ++answers[t.answer];
        for (std::size_t f = 0; f < s.factors.size(); ++f) {
            bool const is_paired = b.pairs && b.pairs->factor == int(f);
            if (is_paired && t.is_open_pair) continue;
            for (std::size_t i = 0; i < (is_paired ? t.stimuli.size() : 1); ++i)
                ++levels[f][t.stimuli[i].levels[f]].first;
            ++levels[f][t.stimuli[std::size_t(t.order[0] - 'a')].levels[f]].second;
        }
    }
    std::string text;
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        if (levels[f].size() < 2 || b.rank == int(f)) continue;
        bool const is_paired = b.pairs && b.pairs->factor == int(f);
        text += fmt::format("    {}:", s.factors[f].name);
        for (auto const& [level, n] : levels[f])
            if (n.first > 0)
                text += fmt::format(" {} {}{}", s.factors[f].levels[std::size_t(level)].name, n.first,
                                    is_paired ? fmt::format(" ({} first)", n.second) : "");
        text += "\n";
    }
    for (auto const& [answer, n] : answers)
        text += fmt::format("{} {} {}", answer == answers.begin()->first ? "    answers:" : "", answer, n);
    return answers.empty() ? text : text + "\n";
}

void add_transitions(std::string& text, Script const& s, Transitions const& t)
{
    text += fmt::format(
        "  {}{}, {}: {:.0f} % of neighbours differ, by chance {:.0f} %\n", s.blocks[std::size_t(t.block)].name,
        t.pass > 0 ? fmt::format(" (pass {})", t.pass + 1) : "", t.subject, 100 * t.switched, 100 * t.by_chance);
    std::size_t const n = t.names.size();
    if (n > 12) return;
    text += fmt::format("    {:>14}", "from \\ to");
    for (std::string const& name : t.names) text += fmt::format(" {:>8}", name.substr(0, 8));
    text += "\n";
    for (std::size_t from = 0; from < n; ++from) {
        text += fmt::format("    {:>14}", t.names[from].substr(0, 14));
        for (std::size_t to = 0; to < n; ++to) text += fmt::format(" {:>8}", t.counts[from * n + to]);
        text += "\n";
    }
}

std::string procedure_text(Procedure const& p)
{
    std::string text = fmt::format("    {}: {}, {}{} trials", p.name, name_of(p.method),
                                   is_adaptive(p) ? "at most " : "", planned_trials(p));
    if (p.stop.reversals > 0) text += fmt::format(" or {} reversals", p.stop.reversals);
    if (p.method == Method::staircase) text += fmt::format(", converges to {:.2f} % correct", 100 * settles_at(p));
    if (p.method == Method::questplus)
        text += fmt::format(", {} x {} x {} x {} points of prior, {} levels", p.threshold.size(), p.slope.size(),
                            p.guess.size(), p.lapse.size(), p.stimuli.size());
    return text + "\n";
}

/// Blocks and passes in the order of the plan.
std::vector<std::pair<int, int>> passes_of(Plan const& plan)
{
    std::vector<std::pair<int, int>> passes;
    for (PlanStep const& step : plan.steps)
        if (step.kind == PlanStepKind::trial && step.number == 1) passes.emplace_back(step.block, step.pass);
    return passes;
}

} // namespace

std::string clock_text(std::int64_t us)
{
    std::int64_t const s = (us + 500000) / 1000000;
    return s >= 3600 ? fmt::format("{}:{:02}:{:02} h", s / 3600, s / 60 % 60, s % 60)
                     : fmt::format("{}:{:02} min", s / 60, s % 60);
}

TrialCounts count_trials(Plan const& plan, int block, int pass)
{
    TrialCounts n;
    for (PlanStep const& step : plan.steps) {
        if (step.block != block || step.pass != pass) continue;
        n.rests += step.kind == PlanStepKind::rest;
        if (step.kind != PlanStepKind::trial) continue;
        ++(step.trial.phase == Phase::practice ? n.practice
           : step.trial.phase == Phase::main   ? n.main
                                               : n.catches);
    }
    return n;
}

std::string script_text(Script const& s, Plan const& plan)
{
    std::string text =
        fmt::format("{}: {}\n{} participants, {} to {}, seed {}\n", s.id, s.title.empty() ? "no title" : s.title,
                    s.participants.count, make_plan(s, 1).participant_id,
                    make_plan(s, s.participants.count).participant_id, s.seed);
    for (Factor const& f : s.factors) {
        text += fmt::format("factor {}:", f.name);
        for (FactorLevel const& l : f.levels) text += " " + l.name;
        text += "\n";
    }
    constexpr char const* kMethods[] = {"fixed",    "alternate", "latin",
                                        "williams", "random",    "between participants"};
    for (Counterbalance const& c : s.counterbalances) {
        text += fmt::format("order of {}: {}", c.name, kMethods[std::size_t(c.method)]);
        int const cycle = cycle_length(c.method, item_count(s, c));
        text += cycle > 1 ? fmt::format(", {} orders\n", cycle) : "\n";
    }
    for (std::size_t b = 0; b < s.blocks.size(); ++b) {
        TrialCounts const n = count_trials(plan, int(b), 0);
        text += fmt::format("block {}: {}, {} practice, {} main, {} catch trials, {} breaks\n", s.blocks[b].name,
                            facts(s.blocks[b].task).name, n.practice, n.main, n.catches, n.rests);
        for (Procedure const& p : s.blocks[b].procedures) text += procedure_text(p);
    }
    return text;
}

std::string order_text(Script const& s, Plan const& plan)
{
    std::string text;
    for (PlanStep const& step : plan.steps) {
        if (step.kind == PlanStepKind::trial) {
            if (step.number == 1) {
                std::string const fixed = fixed_levels(s, step.levels);
                text +=
                    fmt::format("{:>12}  {}{}\n", clock_text(step.start_us),
                                s.blocks[std::size_t(step.block)].name, fixed.empty() ? "" : " (" + fixed + ")");
            }
            text += fmt::format("{:>12}  {}\n", "", trial_text(s, step));
            continue;
        }
        std::string what = first_line(step.text);
        if (step.questionnaire >= 0) what = s.questionnaires[std::size_t(step.questionnaire)].name;
        if (step.kind == PlanStepKind::rest) what = fmt::format("{:g} s {}", step.seconds, what);
        text += fmt::format("{:>12}  {} {}\n", clock_text(step.start_us), name_of(step.kind), what);
    }
    return text;
}

std::string statistics_text(Script const& s, Plan const& plan)
{
    std::string text = "trials: practice, main, catch\n";
    TrialCounts all;
    for (auto const& [block, pass] : passes_of(plan)) {
        TrialCounts const n = count_trials(plan, block, pass);
        text += fmt::format("  {:<24} {:>4} {:>5} {:>4}\n", s.blocks[std::size_t(block)].name, n.practice, n.main,
                            n.catches);
        text += condition_counts(s, plan, block, pass);
        all.practice += n.practice;
        all.main += n.main;
        all.catches += n.catches;
    }
    text += fmt::format("  {:<24} {:>4} {:>5} {:>4}\n", "together", all.practice, all.main, all.catches);
    auto const transitions = find_transitions(s, plan);
    if (!transitions.empty()) text += "from one trial to the next\n";
    for (Transitions const& t : transitions) add_transitions(text, s, t);
    return text;
}

} // namespace study
