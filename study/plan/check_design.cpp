#include "study/script/condition.h"
#include "study/script/read.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

class Checker {
public:
    Checker(Script& s, Mistakes& m, std::function<bool(std::string const&)> const& mentions)
        : s_(s),
          m_(m),
          mentions_(mentions),
          was_sound_(m.empty()),
          factor_used_(s.factors.size()),
          block_used_(s.blocks.size()),
          balance_used_(s.counterbalances.size()),
          questionnaire_used_(s.questionnaires.size())
    {
    }

    void check()
    {
        std::vector<bool> fixed(s_.factors.size());
        for (std::size_t i = 0; i < s_.counterbalances.size(); ++i)
            if (s_.counterbalances[i].method == Balance::between) {
                fixed[std::size_t(s_.counterbalances[i].factor)] = true;
                factor_used_[std::size_t(s_.counterbalances[i].factor)] = true;
                balance_used_[i] = true;
            }
        walk(s_.sequence, fixed);
        check_used();
        check_overridden();
        for (auto const& [factor, error] : without_level_)
            if (factor_used_[std::size_t(factor)] && !m_.suggests(name(factor))) m_.add(error);
        check_devices();
    }

private:
    ScriptError error(Place where, std::string const& problem, std::string const& why,
                      std::string const& suggestion) const
    {
        return {s_.file, where, problem, why, suggestion};
    }
    void fail(Place where, std::string const& problem, std::string const& why, std::string const& suggestion)
    {
        m_.add(error(where, problem, why, suggestion));
    }
    /// After mistakes, parts that something mentions, or seems to mean, count as used.
    bool is_surely_unused(std::string const& name) const
    {
        return was_sound_ || (!mentions_(name) && !m_.suggests(name));
    }
    std::string const& name(int factor) const { return s_.factors[std::size_t(factor)].name; }

    void walk(std::vector<SequenceItem> const& items, std::vector<bool> const& fixed)
    {
        for (SequenceItem const& item : items) {
            if (item.kind == SequenceKind::questionnaire) questionnaire_used_[std::size_t(item.index)] = true;
            if (item.kind == SequenceKind::block) check_block(item.index, fixed, item.place);
            if (item.kind == SequenceKind::group) {
                balance_used_[std::size_t(item.index)] = true;
                for (int const b : s_.counterbalances[std::size_t(item.index)].blocks)
                    check_block(b, fixed, item.place);
            }
            if (item.kind == SequenceKind::free_walk) check_walk(item, fixed);
            if (item.kind == SequenceKind::per) check_per(item, fixed);
        }
    }

    void check_per(SequenceItem const& item, std::vector<bool> fixed)
    {
        if (item.index < 0) return walk(item.items, fixed); // reported: no factor of that name
        std::size_t const f = std::size_t(item.index);
        if (fixed[f]) // reported; the rest is checked nevertheless
            fail(item.place, fmt::format("per: {} where its level is fixed already", name(item.index)),
                 "an outer 'per' or 'between' chose it", "remove one of them");
        for (std::size_t i = 0; i < s_.counterbalances.size(); ++i)
            if (s_.counterbalances[i].factor == item.index) balance_used_[i] = true;
        factor_used_[f] = fixed[f] = true;
        walk(item.items, fixed);
    }

    void check_walk(SequenceItem const& item, std::vector<bool> known)
    {
        for (LevelChoice const& c : item.choice) {
            if (known[std::size_t(c.factor)])
                fail(item.place, fmt::format("the walk sets '{}', which is fixed here", name(c.factor)),
                     "'per' or 'between' chose its level", "leave it out of condition");
            known[std::size_t(c.factor)] = factor_used_[std::size_t(c.factor)] = true;
        }
        check_known(known, item.place, "the free walk");
    }

    /// Every factor must have a level in every stimulus. Returns whether it has.
    bool check_known(std::vector<bool> known, Place where, std::string const& what)
    {
        bool has_all = true;
        for (LevelChoice const& c : s_.reference) known[std::size_t(c.factor)] = true;
        for (std::size_t f = 0; f < known.size(); ++f) {
            if (known[f]) continue;
            has_all = false;
            // Reported only for factors that are used; the others are reported as unused.
            without_level_.emplace_back(
                int(f), error(where, fmt::format("factor '{}' has no level in {}", name(int(f)), what),
                              "the stimuli are not fully defined",
                              fmt::format("cross it, or fix it: only: {{{0}: LEVEL}} in a block, "
                                          "condition: {{{0}: LEVEL}} of a walk, per: {0}, "
                                          "reference: {{{0}: LEVEL}}",
                                          name(int(f)))));
        }
        return has_all;
    }

    void check_block(int index, std::vector<bool> const& fixed, Place from)
    {
        Block& b = s_.blocks[std::size_t(index)];
        block_used_[std::size_t(index)] = true;
        if (b.questionnaire >= 0) questionnaire_used_[std::size_t(b.questionnaire)] = true;
        std::vector<bool> known = fixed;
        bool is_sound = true;
        auto const takes = [&](int factor, char const* how) {
            if (factor < 0) return; // of a broken block
            std::size_t const f = std::size_t(factor);
            if (fixed[f] && !b.is_broken)
                fail(b.place,
                     fmt::format("block '{}' {} '{}', which is fixed where it runs (line {})", b.name, how,
                                 name(factor), from.line),
                     "'per' or 'between' chose its level", "remove one of them");
            else if (known[f] && !b.is_broken)
                fail(b.place,
                     fmt::format("block '{}' {} '{}', whose levels are already chosen", b.name, how, name(factor)),
                     "a factor can be used only once", "remove one");
            is_sound &= !known[f];
            known[f] = factor_used_[f] = true;
        };
        for (int const f : b.cross) takes(f, "crosses");
        for (Nest const& n : b.nest) takes(n.factor, "nests");
        if (b.pairs) takes(b.pairs->factor, "pairs");
        if (b.compare && b.compare->factor >= 0) takes(b.compare->factor, "compares");
        if (b.rank >= 0) takes(b.rank, "ranks");
        bool const shows_reference = b.task == Task::pair_with_reference;
        for (LevelChoice const& c : shows_reference ? s_.reference : b.compare ? b.compare->against : Choice{})
            if (s_.factors[std::size_t(c.factor)].levels.size() == 1) factor_used_[std::size_t(c.factor)] = true;
        for (std::size_t f = 0; f < b.only.size(); ++f) {
            if (b.only[f].empty() || std::find(b.cross.begin(), b.cross.end(), int(f)) != b.cross.end()) continue;
            takes(int(f), "limits");
            if (b.only[f].size() == 1 || b.is_broken) continue;
            is_sound = false;
            fail(b.place,
                 fmt::format("block '{}' has several levels of '{}' that it does not cross", b.name, name(int(f))),
                 "the level to show is undefined", fmt::format("add {} to cross", name(int(f))));
        }
        if (b.is_broken) return;
        is_sound &= check_known(known, b.place, "block '" + b.name + "'");
        for (Constraint const& c : b.constraints) is_sound &= check_constraint(b, c);
        b.is_broken = !is_sound;
    }

    /// Returns whether it can hold.
    bool check_constraint(Block const& b, Constraint const& c)
    {
        bool const nested =
            std::any_of(b.nest.begin(), b.nest.end(), [&](Nest const& n) { return n.factor == c.factor; });
        bool const crossed = std::find(b.cross.begin(), b.cross.end(), c.factor) != b.cross.end() || nested;
        bool const is_paired =
            (b.pairs && b.pairs->factor == c.factor) || (b.compare && b.compare->factor == c.factor);
        if (b.pairs && b.pairs->is_active() && (is_paired || c.subject == Subject::pair)) {
            fail(c.place, fmt::format("a rule for pairs of block '{}' that are chosen during the session", b.name),
                 "their order is not planned", "remove it");
            return false;
        }
        bool varies = crossed || is_paired;
        if (c.subject == Subject::pair) varies = b.pairs || (b.compare && b.compare->factor >= 0);
        if (c.subject == Subject::answer) varies = !presented_orders(b.task, false).empty();
        if (c.subject == Subject::procedure) varies = b.procedures.size() > 1;
        if (!varies)
            fail(c.place, fmt::format("the subject of this rule is the same in all trials of block '{}'", b.name),
                 "no order can satisfy it", "cross the factor or remove the rule");
        if (!varies) return false;
        bool const is_defined = !is_paired || c.kind == RuleKind::max_run || c.kind == RuleKind::min_gap;
        if (!is_defined)
            fail(c.place, fmt::format("'{}' has two levels in a trial of block '{}'", name(c.factor), b.name),
                 "only no_repeat, max_run and min_gap are defined then", "use one of these");
        return is_defined;
    }

    void check_used()
    {
        for (std::size_t f = 0; f < s_.factors.size(); ++f)
            if (!factor_used_[f] && is_surely_unused(s_.factors[f].name))
                fail(s_.factors[f].place, fmt::format("factor '{}' is not used", s_.factors[f].name),
                     "no block of the sequence uses it", "cross it in a block, or remove it");
        for (std::size_t b = 0; b < s_.blocks.size(); ++b)
            if (!block_used_[b] && is_surely_unused(s_.blocks[b].name))
                fail(s_.blocks[b].place, fmt::format("block '{}' is not used", s_.blocks[b].name),
                     "the sequence does not contain it", "add it to the sequence, or remove it");
        for (std::size_t i = 0; i < s_.counterbalances.size(); ++i)
            if (!balance_used_[i] && is_surely_unused(s_.counterbalances[i].name))
                fail(s_.counterbalances[i].place,
                     fmt::format("the order '{}' is not used", s_.counterbalances[i].name),
                     "nothing in the sequence uses it",
                     s_.counterbalances[i].factor >= 0
                         ? fmt::format("add {{per: {}, do: [...]}}", s_.counterbalances[i].name)
                         : fmt::format("add '{}' to the sequence", s_.counterbalances[i].name));
        for (std::size_t i = 0; i < s_.sounds.size(); ++i) {
            auto const plays_it = [&](Cue const& c) { return c.sound == int(i); };
            bool const is_used = std::any_of(s_.blocks.begin(), s_.blocks.end(), [&](Block const& b) {
                return std::any_of(b.cues.begin(), b.cues.end(), plays_it);
            });
            if (!is_used && is_surely_unused(s_.sounds[i].name))
                fail(s_.sounds[i].place, fmt::format("sound '{}' is not used", s_.sounds[i].name),
                     "no cue plays it",
                     fmt::format("add cues: [{{sound: {}}}] to a block, or remove it", s_.sounds[i].name));
        }
        for (std::size_t q = 0; q < s_.questionnaires.size(); ++q)
            if (!questionnaire_used_[q] && s_.questionnaires[q].place.line > 0 &&
                is_surely_unused(s_.questionnaires[q].name))
                fail(s_.questionnaires[q].place,
                     fmt::format("questionnaire '{}' is not used", s_.questionnaires[q].name),
                     "nothing in the sequence asks it", "add it to the sequence, or remove it");
    }

    /// Settings of all levels of a factor, or of any.
    std::set<std::string> settings_of_levels(std::size_t factor, bool of_all) const
    {
        std::map<std::string, std::size_t> count;
        for (FactorLevel const& level : s_.factors[factor].levels)
            for (auto const& [key, unused] : level.settings) ++count[plain_key(key)];
        std::set<std::string> keys;
        for (auto const& [key, levels] : count)
            if (!of_all || levels == s_.factors[factor].levels.size()) keys.insert(key);
        return keys;
    }

    /// Later factors override earlier ones in every stimulus, as it has a level of each.
    void check_overridden()
    {
        for (std::size_t i = 0; i < s_.factors.size(); ++i) {
            auto const own = settings_of_levels(i, false);
            if (own.empty() || s_.factors[i].levels.size() < 2) continue;
            for (std::size_t j = i + 1; j < s_.factors.size(); ++j) {
                auto const later = settings_of_levels(j, true);
                if (!std::includes(later.begin(), later.end(), own.begin(), own.end())) continue;
                fail(s_.factors[i].place,
                     fmt::format("nothing of factor '{}' is shown: factor '{}' sets '{}' too", name(int(i)),
                                 name(int(j)), *own.begin()),
                     "later factors override earlier ones", "remove one, or let them set different settings");
                break;
            }
        }
    }

    /// Checks that no input gives two of these answers. @param where  place where they are asked for
    void check_inputs(std::set<std::string> const& answers, std::string const& where)
    {
        std::map<std::string, std::string> answer_by_input;
        for (Device const& d : s_.devices) {
            if (!answers.contains(d.answer)) continue;
            for (std::string const& input : d.inputs) {
                auto const [other, is_new] = answer_by_input.emplace(input, d.answer);
                if (is_new || !ambiguous_.emplace(input, d.answer).second) continue;
                fail(d.place, fmt::format("'{}' is both {} and {} in {}", input, other->second, d.answer, where),
                     "the answer would be ambiguous", "choose another input");
            }
        }
    }

    void check_devices()
    {
        std::set<std::string> answers{"pause"};
        auto const check = [&](Task task, bool may_tie, std::string const& where) {
            std::set<std::string> own{"pause"};
            for (auto const a : facts(task).answers) own.emplace(a);
            if (may_tie) own.emplace("neither");
            check_inputs(own, where);
            answers.merge(own);
        };
        bool knows_tasks = true;
        for (Block const& b : s_.blocks) {
            if (b.knows_task) check(b.task, b.may_tie, "block '" + b.name + "'");
            knows_tasks &= b.knows_task;
        }
        for (std::size_t q = 0; q < s_.questionnaires.size(); ++q)
            if (questionnaire_used_[q])
                check(Task::questionnaire, false, "questionnaire '" + s_.questionnaires[q].name + "'");
        for (Device const& d : s_.devices)
            if (!answers.contains(d.answer) && knows_tasks)
                fail(d.place, fmt::format("the answer '{}' is not used", d.answer), "no task of the script has it",
                     "remove it");
    }

    Script& s_;
    Mistakes& m_;
    std::function<bool(std::string const&)> const& mentions_;
    bool was_sound_;                                          ///< the script was read without mistakes
    std::vector<std::pair<int, ScriptError>> without_level_;  ///< by factor
    std::set<std::pair<std::string, std::string>> ambiguous_; ///< reported: input and answer
    std::vector<bool> factor_used_, block_used_, balance_used_, questionnaire_used_;
};

} // namespace

void check_design(Script& script, Mistakes& m, std::function<bool(std::string const&)> const& mentions)
{
    Checker(script, m, mentions).check();
}

} // namespace study
