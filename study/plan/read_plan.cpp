#include "study/plan/plan_columns.h"

#include "gi/core/text.h"
#include "study/plan/duration.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace study {
namespace {

using Cells = std::vector<std::string_view>;

Cells cells_of_line(std::string_view line)
{
    if (line.ends_with('\r')) line.remove_suffix(1);
    Cells cells;
    std::size_t tab;
    do {
        tab = line.find('\t');
        cells.push_back(line.substr(0, tab));
        line.remove_prefix(tab == line.npos ? line.size() : tab + 1);
    } while (tab != std::string_view::npos);
    return cells;
}

std::vector<Cells> rows_of(std::string_view table)
{
    std::vector<Cells> rows;
    while (!table.empty()) rows.push_back(cells_of_line(gi::take_until(table, '\n')));
    return rows;
}

class PlanReader {
public:
    PlanReader(Script const& s, std::string const& file) : s_(s), file_(file), columns_(plan_columns(s)) {}

    Plan read(int participant, std::string_view table)
    {
        std::vector<Cells> const rows = rows_of(table);
        if (rows.empty()) refuse("it is empty");
        for (std::string const& column : columns_) {
            auto const found = std::find(rows[0].begin(), rows[0].end(), column);
            if (found == rows[0].end()) refuse(fmt::format("it has no column '{}'", column));
            places_.push_back(std::size_t(found - rows[0].begin()));
        }
        Plan plan;
        plan.participant = participant;
        plan.participant_id = participant_id(s_, participant);
        for (std::size_t i = 1; i < rows.size(); ++i) {
            row_ = &rows[i];
            line_ = int(i) + 1;
            if (row_->size() != rows[0].size()) refuse("it has another number of cells than the first line");
            if (number("step") != int(i)) refuse(fmt::format("it is not step {}", i));
            plan.steps.push_back(read_step());
            PlanStep& step = plan.steps.back();
            step.start_us = plan.duration_us;
            step.onset_us = microseconds("onset");
            plan.duration_us += step.duration_us;
        }
        return plan;
    }

private:
    [[noreturn]] void refuse(std::string const& why) const
    {
        throw ScriptError(file_, {line_, 1}, "this plan cannot be read", why, "restore the file from a copy");
    }

    /// The cell of this row; empty = n/a.
    std::string_view cell(std::string_view column) const
    {
        auto const at = std::find(columns_.begin(), columns_.end(), column) - columns_.begin();
        std::string_view const text = (*row_)[places_[std::size_t(at)]];
        return text == "n/a" ? std::string_view() : text;
    }
    int number(std::string_view column) const
    {
        auto const value = gi::parse_number<int>(cell(column));
        if (!value || *value < 1) refuse(fmt::format("its {} is no number from 1", column));
        return *value;
    }
    std::int64_t microseconds(std::string_view column) const
    {
        auto const value = gi::parse_finite(cell(column), 1e9);
        if (!value || *value < 0) refuse(fmt::format("its {} is no time", column));
        return std::llround(*value * 1e6);
    }

    /// Index of the item with this name.
    template <class Items>
    int named(Items const& items, std::string_view name, std::string_view what) const
    {
        auto const found =
            std::find_if(items.begin(), items.end(), [&](auto const& item) { return item.name == name; });
        if (found == items.end()) refuse(fmt::format("the script has no {} '{}'", what, name));
        return int(found - items.begin());
    }
    int level_of(int factor, std::string_view name) const
    {
        Factor const& f = s_.factors[std::size_t(factor)];
        return named(f.levels, name, "level of " + f.name);
    }
    template <class Enum>
    Enum word(std::initializer_list<Enum> all, std::string_view column) const
    {
        for (Enum const e : all)
            if (name_of(e) == cell(column)) return e;
        refuse(fmt::format("'{}' is no {}", cell(column), column));
    }

    PlanStep read_step() const
    {
        PlanStep step;
        step.kind = word({PlanStepKind::instructions, PlanStepKind::questionnaire, PlanStepKind::trial,
                          PlanStepKind::rest, PlanStepKind::free_walk},
                         "kind");
        if (!cell("block").empty()) {
            step.block = named(s_.blocks, cell("block"), "block");
            step.pass = number("pass") - 1;
        }
        for (std::size_t f = 0; f < s_.factors.size(); ++f) {
            std::string_view const name = cell(columns_[kFirstFactorColumn + f]);
            step.levels.push_back(name.empty() ? -1 : level_of(int(f), name));
        }
        step.duration_us = microseconds("duration");
        if (step.kind == PlanStepKind::trial) {
            if (step.block < 0) refuse("it is a trial without a block");
            step.number = number("trial");
            step.trial = read_trial(s_.blocks[std::size_t(step.block)], step.levels);
        } else if (step.kind == PlanStepKind::questionnaire) {
            step.questionnaire = named(s_.questionnaires, cell("content"), "questionnaire");
        } else {
            if (step.kind != PlanStepKind::instructions) step.seconds = double(step.duration_us) * 1e-6;
            step.text = text_of(step);
        }
        return step;
    }

    Trial read_trial(Block const& b, std::vector<int> const& levels) const
    {
        Trial t;
        t.phase = word({Phase::practice, Phase::main, Phase::catches}, "phase");
        t.repeat = number("repeat");
        t.order = cell("order");
        t.answer = cell("answer");
        t.level = level(b);
        if (!cell("procedure").empty()) t.procedure = named(b.procedures, cell("procedure"), "procedure");
        read_stimuli(b, {levels, false, {}}, t);
        for (PresentedOrder const& o : presented_orders(b.task, false))
            if (o.letters == t.order && o.answer == t.answer) t.is_noise = o.is_noise;
        for (Stimulus const& stimulus : t.stimuli) check_levels(stimulus);
        if (t.reference) check_levels(*t.reference);
        auto const is_shown = [&](char c) {
            return std::size_t(c - 'a') < t.stimuli.size() || (c == 'r' && t.reference);
        };
        if (t.order.empty() || !std::all_of(t.order.begin(), t.order.end(), is_shown))
            refuse("its order is not of its stimuli");
        return t;
    }

    /// @param base levels of the trial's condition
    void read_stimuli(Block const& b, Stimulus const& base, Trial& t) const
    {
        int const compared = compared_factor(b);
        auto const with_label = [&](std::string_view label) {
            Stimulus s = base;
            if (compared >= 0 && !label.empty()) s.levels[std::size_t(compared)] = level_of(compared, label);
            return s;
        };
        auto const with_choice = [](Stimulus s, Choice const& choice) {
            for (LevelChoice const& c : choice) s.levels[std::size_t(c.factor)] = c.level;
            return s;
        };
        Cells labels{cell("cond_a")};
        if (!cell("cond_b").empty()) labels.push_back(cell("cond_b"));
        for (std::string_view more = cell("cond_more"); !more.empty();)
            labels.push_back(gi::take_until(more, ','));
        t.is_open_pair = b.pairs && b.pairs->is_active() && labels[0].empty();
        if (t.is_open_pair) { // until it is chosen, it is the first one
            auto const& levels = s_.factors[std::size_t(compared)].levels;
            auto const [first, second] = b.pairs->pairs.front();
            labels = {levels[std::size_t(first)].name, levels[std::size_t(second)].name};
        }
        if (b.compare) {
            bool const is_adjusted = b.task == Task::adjustment;
            std::string_view const other = is_adjusted || labels.size() < 2 ? cell("reference") : labels[1];
            t.stimuli = {with_label(labels[0]), with_choice(with_label(other), b.compare->against)};
            t.stimuli[0].is_varied = true;
            t.stimuli[0].level = t.level;
            if (!is_adjusted) return;
            t.reference = t.stimuli.back();
            t.stimuli.pop_back();
            return;
        }
        if (!b.pairs && b.rank < 0) labels = {""};
        for (std::string_view const label : labels) t.stimuli.push_back(with_label(label));
        if (b.pairs && t.stimuli.size() != 2) refuse("it has no pair");
        if (b.task == Task::pair_with_reference)
            t.reference = with_choice(with_label(cell("reference")), s_.reference);
        if (b.magnitude.modulus > 0) t.reference = with_choice(base, b.magnitude.standard);
    }

    void check_levels(Stimulus const& s) const
    {
        for (std::size_t f = 0; f < s.levels.size(); ++f)
            if (s.levels[f] < 0) refuse("it has no level of " + s_.factors[f].name);
    }

    /// Tables have nine digits: a level of the script is restored to its last bit.
    std::optional<double> level(Block const& b) const
    {
        std::string_view const text = cell("level");
        if (text.empty()) return {};
        std::vector<double> known{b.catches.level};
        for (Procedure const& p : b.procedures) known.insert(known.end(), p.levels.begin(), p.levels.end());
        if (b.compare) known.push_back(b.practice.level.value_or(easiest(*b.compare)));
        for (double const v : known)
            if (level_text(v) == text) return v;
        auto const value = gi::parse_finite(text);
        if (!value) refuse("its level is no number");
        return value;
    }

    /// The text of the script that begins so; if there are several, the one that takes as long to read.
    std::string text_of(PlanStep const& step) const
    {
        std::string const content(cell("content"));
        std::vector<std::string> fitting;
        auto const consider = [&](std::string const& text) {
            if (plan_content(text) == content) fitting.push_back(text);
        };
        if (step.block >= 0)
            consider(s_.blocks[std::size_t(step.block)].instructions);
        else
            visit(s_.sequence, consider);
        for (std::string const& text : fitting)
            if (step.kind == PlanStepKind::instructions && reading_us(text) == step.duration_us) return text;
        return fitting.empty() ? content : fitting.front();
    }
    static void visit(std::vector<SequenceItem> const& items, auto const& consider)
    {
        for (SequenceItem const& item : items) {
            consider(item.text);
            visit(item.items, consider);
        }
    }

    Script const& s_;
    std::string const& file_;
    std::vector<std::string> columns_; ///< as this version writes them
    std::vector<std::size_t> places_;  ///< of these columns in the table
    Cells const* row_ = nullptr;
    int line_ = 1;
};

} // namespace

Plan read_plan(Script const& script, int participant, std::string_view table, std::string const& file)
{
    return PlanReader(script, file).read(participant, table);
}

std::string plan_difference(std::string_view recorded, std::string_view made)
{
    std::vector<Cells> const a = rows_of(recorded), b = rows_of(made);
    if (a.empty() || b.empty()) return a.empty() && b.empty() ? "" : "one of them has no step";
    std::size_t const rows = std::max(a.size(), b.size());
    std::size_t differing = 0, first = 0;
    Cells columns; // that differ in the first one
    for (std::size_t i = 1; i < rows; ++i) {
        Cells here;
        if (i < a.size() && i < b.size())
            for (std::size_t c = 0; c < std::min({a[0].size(), a[i].size(), b[i].size()}); ++c) {
                auto const at = std::find(b[0].begin(), b[0].end(), a[0][c]);
                std::size_t const k = std::size_t(at - b[0].begin());
                if (k >= b[i].size() || a[i][c] != b[i][k]) here.push_back(a[0][c]);
            }
        if (here.empty() && i < a.size() && i < b.size()) continue;
        if (differing++ > 0) continue;
        first = i;
        columns = here;
    }
    if (differing == 0) return a[0] == b[0] ? "" : "their columns differ";
    std::string const which =
        columns.empty() ? "which only one of them has" : fmt::format("{}", fmt::join(columns, ", "));
    return fmt::format("{} of {} steps differ, the first is step {} ({})", differing, a.size() - 1, first, which);
}

} // namespace study
