#include "study/plan/plan_columns.h"

#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

std::string or_none(std::string const& text) { return text.empty() ? "n/a" : text; }

std::string seconds(std::int64_t us) { return fmt::format("{}.{:06}", us / 1000000, us % 1000000); }
std::string milliseconds(double ms) { return fmt::format("{:.9g}", ms); }

/// "640/arches": levels of factors in the cell of the trial, n/a if not fixed.
void add_levels(std::vector<std::string>& row, Script const& s, PlanStep const& step)
{
    Block const* const b = step.block >= 0 ? &s.blocks[std::size_t(step.block)] : nullptr;
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        int level = step.levels[f];
        bool is_compared = false;
        if (step.kind == PlanStepKind::trial) {
            level = step.trial.stimuli[0].levels[f];
            is_compared = compared_factor(*b) == int(f);
        }
        row.push_back(level < 0 || is_compared ? "n/a" : s.factors[f].levels[std::size_t(level)].name);
    }
}

void add_trial(std::vector<std::string>& row, Script const& s, PlanStep const& step)
{
    Block const& b = s.blocks[std::size_t(step.block)];
    Trial const& t = step.trial;
    std::string more;
    for (std::size_t i = 2; i < t.stimuli.size(); ++i)
        more += (more.empty() ? "" : ",") + stimulus_label(s, b, t.stimuli[i]);
    row.push_back(t.is_open_pair ? "n/a" : stimulus_label(s, b, t.stimuli[0]));
    row.push_back(t.stimuli.size() > 1 && !t.is_open_pair ? stimulus_label(s, b, t.stimuli[1]) : "n/a");
    row.push_back(or_none(more));
    row.push_back(t.reference ? stimulus_label(s, b, *t.reference) : "n/a");
    row.push_back(t.order);
    row.push_back(t.level ? level_text(*t.level) : "n/a");
    row.push_back(t.procedure >= 0 ? b.procedures[std::size_t(t.procedure)].name : "n/a");
    row.push_back(or_none(t.answer));
    row.push_back(std::to_string(b.timing.warmup_frames));
    row.push_back(milliseconds(b.timing.isi_ms));
    row.push_back(b.timing.stimulus_ms ? milliseconds(*b.timing.stimulus_ms) : "n/a");
}

std::vector<std::string> row_of(Script const& s, PlanStep const& step, std::size_t index)
{
    bool const is_trial = step.kind == PlanStepKind::trial;
    std::vector<std::string> row{std::to_string(index + 1), std::string(name_of(step.kind))};
    row.push_back(step.block >= 0 ? s.blocks[std::size_t(step.block)].name : "n/a");
    row.push_back(step.block >= 0 ? std::to_string(step.pass + 1) : "n/a");
    row.push_back(is_trial ? std::to_string(step.number) : "n/a");
    row.push_back(is_trial ? std::string(name_of(step.trial.phase)) : "n/a");
    row.push_back(is_trial ? std::string(facts(s.blocks[std::size_t(step.block)].task).name) : "n/a");
    row.push_back(is_trial ? std::to_string(step.trial.repeat) : "n/a");
    add_levels(row, s, step);
    if (is_trial)
        add_trial(row, s, step);
    else
        row.insert(row.end(), 11, "n/a");
    row.push_back(is_trial ? seconds(step.onset_us) : seconds(step.start_us));
    row.push_back(seconds(step.duration_us));
    row.push_back(step.questionnaire >= 0 ? s.questionnaires[std::size_t(step.questionnaire)].name
                                          : or_none(plan_content(step.text)));
    return row;
}

std::string joined(std::vector<std::string> const& cells)
{
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) line += (i ? "\t" : "") + cells[i];
    return line + "\n";
}

} // namespace

std::string stimulus_label(Script const& s, Block const& b, Stimulus const& stimulus)
{
    auto const level_name = [&](int factor) {
        return s.factors[std::size_t(factor)].levels[std::size_t(stimulus.levels[std::size_t(factor)])].name;
    };
    if (b.pairs) return level_name(b.pairs->factor);
    if (b.rank >= 0) return level_name(b.rank);
    if (b.compare && b.compare->factor >= 0) return level_name(b.compare->factor);
    if (b.compare) return stimulus.is_varied ? b.compare->vary : "reference";
    std::string label;
    for (int const f : b.cross) label += (label.empty() ? "" : ",") + level_name(f);
    for (Nest const& n : b.nest) label += (label.empty() ? "" : ",") + level_name(n.factor);
    return label.empty() ? "n/a" : label;
}

std::vector<std::string> plan_columns(Script const& script)
{
    std::vector<std::string> columns{"step", "kind", "block", "pass", "trial", "phase", "task", "repeat"};
    for (Factor const& f : script.factors) {
        bool const is_taken = std::find(columns.begin(), columns.end(), f.name) != columns.end();
        columns.push_back(is_taken ? "factor_" + f.name : f.name);
    }
    for (char const* name : {"cond_a", "cond_b", "cond_more", "reference", "order", "level", "procedure", "answer",
                             "warmup_frames", "isi_ms", "stimulus_ms", "onset", "duration", "content"}) {
        for (std::string& column : columns)
            if (column == name) column = "factor_" + column;
        columns.emplace_back(name);
    }
    return columns;
}

std::string plan_content(std::string text)
{
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return gi::shortened(text, 60);
}

std::string plan_table(Script const& script, Plan const& plan)
{
    std::string table = joined(plan_columns(script));
    for (std::size_t i = 0; i < plan.steps.size(); ++i) table += joined(row_of(script, plan.steps[i], i));
    return table;
}

} // namespace study
