#include "study/imported/made_trials.h"

#include "study/imported/decimal_number.h"
#include "study/imported/table_doubts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <set>

namespace study {
namespace {

/// Names of levels in numeric order if all are numbers.
std::vector<std::string> ordered(std::vector<std::string> names)
{
    bool const are_numbers =
        std::all_of(names.begin(), names.end(), [](std::string const& n) { return read_decimal(n).has_value(); });
    if (are_numbers)
        std::stable_sort(names.begin(), names.end(), [](auto const& a, auto const& b) {
            return read_decimal(a)->value < read_decimal(b)->value;
        });
    return names;
}

/// Names in the order of their first use, with their places.
class NameList {
public:
    int add(std::string const& name)
    {
        auto const [it, is_new] = at_.emplace(name, int(names_.size()));
        if (is_new) names_.push_back(name);
        return it->second;
    }
    std::vector<std::string> const& names() const { return names_; }

private:
    std::map<std::string, int> at_;
    std::vector<std::string> names_;
};

Factor factor_of(std::string const& name, std::vector<std::string> const& levels)
{
    Factor f;
    f.name = name;
    for (std::string const& l : levels) f.levels.push_back({l, {}});
    return f;
}

/// Levels of a factor by participant, in the order of their names.
std::map<std::string, std::set<std::string>> levels_of_people(MadeExperiment const& made, std::size_t factor)
{
    std::map<std::string, std::set<std::string>> levels;
    for (MadeTrial const& t : made.trials) levels[t.participant].insert(t.factors[factor]);
    return levels;
}

bool is_between(MadeExperiment const& made, std::size_t factor)
{
    std::set<std::string> all;
    auto const levels = levels_of_people(made, factor);
    for (auto const& [unused, own] : levels) all.insert(own.begin(), own.end());
    return all.size() > 1 &&
           std::all_of(levels.begin(), levels.end(), [](auto const& of) { return of.second.size() == 1; });
}

/// Whether all trials of each level stand together, as where tables of groups were joined, each with the same ids in the order
/// of its own trials. Tables that a program turned from wide to long stand so, too, but have the same trials in each level.
bool are_levels_joined(MadeExperiment const& made, std::size_t factor)
{
    std::vector<std::vector<std::string>> blocks; // what is shown to whom, by level
    std::vector<std::set<std::string>> people;
    std::set<std::string> levels;
    std::string const* last = nullptr;
    for (MadeTrial const& t : made.trials) {
        std::string const& level = t.factors[factor];
        if (last == nullptr || level != *last) {
            if (!levels.insert(level).second) return false;
            blocks.emplace_back();
            people.emplace_back();
        }
        last = &level;
        std::string shown = fmt::format("{}\x1f{}\x1f{}", t.participant, t.run, t.level.value_or(0));
        for (std::string const& item : t.items) shown += '\x1f' + item;
        for (std::size_t f = 0; f < t.factors.size(); ++f)
            if (f != factor) shown += '\x1f' + t.factors[f];
        blocks.back().push_back(std::move(shown));
        people.back().insert(t.participant);
    }
    bool const have_several =
        std::all_of(people.begin(), people.end(), [](auto const& ids) { return ids.size() > 1; });
    return have_several && std::adjacent_find(blocks.begin(), blocks.end(), std::not_equal_to<>()) != blocks.end();
}

/// A caution if one id seems to be given to several people: a factor of the people themselves by its name; levels that stand
/// together under numbers from 1; or a factor of which only a few have several levels. Empty if not.
std::string shared_ids(MadeExperiment const& made, std::size_t factor)
{
    std::vector<std::string> who, all;
    std::string example;
    int pieces = 0; // people, if each level has its own
    for (auto const& [id, own] : levels_of_people(made, factor)) {
        all.push_back(id);
        pieces += int(own.size());
        if (own.size() == 1) continue;
        who.push_back(id);
        if (example.empty()) example = fmt::format("{}", fmt::join(own, " and "));
    }
    std::size_t const one = all.size() - who.size();
    bool const is_few = who.size() < one;
    if (who.empty() || all.size() < 2) return {};
    std::string const& name = made.factors[factor];
    if (!is_few && !names_people(name) && !(are_numbered(all) && are_levels_joined(made, factor))) return {};
    std::string text =
        fmt::format("'{}': {} participant{} ({}) {} several levels ({})", name, who.size(),
                    who.size() == 1 ? "" : "s", named_few(who), who.size() == 1 ? "has" : "have", example);
    if (one > 0) text += fmt::format(", the other {} have one each", one);
    text += ": it is taken as within participants; if an id was used for ";
    if (is_few)
        return text +
               fmt::format("two people, rename one, or use participant={}+{}", name, made.participant_column);
    return text + fmt::format("several people, {} are analysed as {}: use participant={}+{}", pieces, all.size(),
                              name, made.participant_column);
}

bool is_of_pairs(Task task) { return task == Task::pair || task == Task::pair_with_reference; }

void add_values(MadeExperiment const& made, Block& b)
{
    double low = 1e300, high = -1e300;
    bool whole = true;
    for (MadeTrial const& t : made.trials) {
        low = std::min(low, *t.value);
        high = std::max(high, *t.value);
        whole = whole && *t.value == std::floor(*t.value);
    }
    b.scale.low = low;
    b.scale.high = high > low ? high : low + 1;
    b.scale.step = whole ? 1 : (b.scale.high - b.scale.low) / 20;
    if (made.task == Task::adjustment) {
        Compare c;
        c.vary = "value";
        c.scale = made.scale;
        c.low = low;
        c.high = b.scale.high;
        b.compare = c;
    }
}

void add_levels(MadeExperiment const& made, Block& b)
{
    std::set<double> levels;
    for (MadeTrial const& t : made.trials)
        if (t.level) levels.insert(*t.level);
    if (levels.empty()) return;
    Compare c;
    c.vary = made.level_name;
    c.scale = made.scale;
    c.low = *levels.begin();
    c.high = *levels.rbegin();
    c.harder_up = made.harder_up;
    b.compare = c;
    Procedure p;
    p.psychometric = PsychometricChoice{Psychometric::normal, {}}; // probit, as most programs fit
    p.name = "table";
    p.method = Method::constant;
    p.levels.assign(levels.begin(), levels.end());
    b.procedures.push_back(std::move(p));
}

/// The script, with a factor for the items after those of the table.
Script script_of(MadeExperiment const& made, std::vector<std::vector<std::string>> const& levels,
                 std::vector<std::string> const& items, std::vector<std::string>& notes)
{
    Script s;
    s.file = made.file;
    s.id = made.id;
    s.seed = 1;
    Block b;
    b.name = "table";
    b.task = made.task;
    for (std::size_t f = 0; f < levels.size(); ++f) {
        s.factors.push_back(factor_of(made.factors[f], levels[f]));
        if (!is_between(made, f)) {
            b.cross.push_back(int(f));
            if (std::string caution = shared_ids(made, f); !caution.empty()) notes.push_back(std::move(caution));
            continue;
        }
        Counterbalance c;
        c.name = made.factors[f];
        c.factor = int(f);
        c.method = Balance::between;
        s.counterbalances.push_back(std::move(c));
        notes.push_back(fmt::format("'{}' differs between participants", made.factors[f]));
    }
    if (!items.empty()) {
        int const item = int(s.factors.size());
        s.factors.push_back(factor_of("item", items));
        if (is_of_pairs(made.task)) {
            Pairs p;
            p.factor = item;
            p.order = PairOrder::random;
            for (int i = 0; i < int(items.size()); ++i)
                for (int j = i + 1; j < int(items.size()); ++j) p.pairs.emplace_back(i, j);
            b.pairs = std::move(p);
        } else
            b.cross.push_back(item);
    }
    b.only.resize(s.factors.size());
    b.may_tie = std::any_of(made.trials.begin(), made.trials.end(),
                            [](MadeTrial const& t) { return t.response == "neither"; });
    if (!is_of_pairs(made.task)) {
        if (made.trials.front().value)
            add_values(made, b);
        else
            add_levels(made, b);
    }
    s.blocks.push_back(std::move(b));
    SequenceItem step;
    step.index = 0;
    s.sequence.push_back(std::move(step));
    return s;
}

std::string answer_of(Task task, MadeTrial const& t)
{
    switch (task) {
    case Task::yes_no:
        return t.is_signal ? "yes" : "no";
    case Task::same_different:
        return t.is_signal ? "different" : "same";
    case Task::abx:
        return t.is_signal ? "first" : "second";
    default:
        return {};
    }
}

} // namespace

ImportedTable sessions_of(MadeExperiment const& made)
{
    ImportedTable out;
    out.notes = made.notes;
    std::vector<NameList> lists(made.factors.size());
    NameList item_list;
    for (MadeTrial const& t : made.trials) {
        for (std::size_t f = 0; f < lists.size(); ++f) lists[f].add(t.factors[f]);
        for (std::string const& i : t.items) item_list.add(i);
    }
    std::vector<std::vector<std::string>> levels;
    std::vector<std::map<std::string, int>> place;
    auto const index = [&](std::vector<std::string> const& names) {
        std::map<std::string, int> at;
        for (std::size_t i = 0; i < names.size(); ++i) at[names[i]] = int(i);
        place.push_back(std::move(at));
    };
    for (NameList const& l : lists) {
        levels.push_back(ordered(l.names()));
        index(levels.back());
    }
    std::vector<std::string> const items = ordered(item_list.names());
    index(items);
    NameList people;
    for (MadeTrial const& t : made.trials) people.add(t.participant);
    auto const doubt = [&](std::string const& what, std::vector<std::string> const& names) {
        if (std::string caution = similar_names_caution(what, names); !caution.empty())
            out.notes.push_back(std::move(caution));
    };
    doubt("participants", people.names());
    doubt("items", items);
    for (std::size_t f = 0; f < levels.size(); ++f)
        doubt(fmt::format("levels of '{}'", made.factors[f]), levels[f]);
    out.script = script_of(made, levels, items, out.notes);

    std::map<std::string, std::size_t> session_of;
    std::vector<NameList> runs;
    for (MadeTrial const& t : made.trials) {
        auto const [it, is_new] = session_of.emplace(t.participant, out.sessions.size());
        if (is_new) {
            RecordedSession session;
            session.detail = made.detail;
            session.plan.participant = int(out.sessions.size()) + 1;
            session.plan.participant_id = t.participant;
            SessionStarted start;
            start.experiment = out.script.id;
            start.participant_id = t.participant;
            start.participant = session.plan.participant;
            start.about.emplace_back("table", made.file);
            session.record.entries.emplace_back(std::move(start));
            out.sessions.push_back(std::move(session));
            runs.emplace_back();
        }
        RecordedSession& session = out.sessions[it->second];
        PlanStep step;
        step.kind = PlanStepKind::trial;
        step.block = 0;
        step.number = int(session.plan.steps.size()) + 1;
        std::vector<int> at;
        for (std::size_t f = 0; f < t.factors.size(); ++f) at.push_back(place[f].at(t.factors[f]));
        step.levels.assign(out.script.factors.size(), -1);
        for (Counterbalance const& c : out.script.counterbalances)
            step.levels[std::size_t(c.factor)] = at[std::size_t(c.factor)];
        for (std::size_t i = 0; i < std::max<std::size_t>(1, t.items.size()); ++i) {
            Stimulus s;
            s.levels = at;
            if (!items.empty()) s.levels.push_back(place.back().at(t.items[i]));
            s.is_varied = i == 0 && t.level.has_value();
            s.level = t.level;
            step.trial.stimuli.push_back(std::move(s));
            step.trial.order += char('a' + i);
        }
        step.trial.repeat = runs[it->second].add(t.run) + 1;
        step.trial.procedure = out.script.blocks[0].procedures.empty() ? -1 : 0;
        step.trial.level = t.level;
        step.trial.is_noise = !t.is_signal && (made.task == Task::yes_no || made.task == Task::same_different);
        step.trial.answer = answer_of(made.task, t);
        TrialDone done;
        done.step = int(session.plan.steps.size());
        done.response = t.response;
        done.value = t.value;
        done.level = t.level;
        done.is_correct = t.is_correct;
        done.reaction_ms = t.reaction_ms;
        session.plan.steps.push_back(std::move(step));
        session.record.entries.emplace_back(std::move(done));
    }
    for (RecordedSession& session : out.sessions) {
        SessionEnded end;
        end.is_complete = true;
        session.record.entries.emplace_back(std::move(end));
    }
    out.script.participants.count = int(out.sessions.size());
    return out;
}

} // namespace study
