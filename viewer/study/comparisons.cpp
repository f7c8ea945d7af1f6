#include "viewer/study/comparisons.h"

#include "gi/core/text.h"
#include "study/script/procedure.h"
#include "viewer/engine/scene_edits.h"
#include "viewer/study/study_settings.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

namespace viewer {
namespace {

using study::plain_key;

std::map<std::string, std::string> plain(study::Patch const& patch)
{
    std::map<std::string, std::string> settings;
    for (auto const& [key, value] : patch) settings[plain_key(key)] = value;
    return settings;
}

/// "" = as the scene has it.
std::string usual_value(std::string const& key)
{
    if (is_scene_edit(key)) return key.ends_with("scale") && !is_object_edit(key) ? "1" : "";
    static std::vector<StudySetting> const all = study_settings();
    auto const s = std::ranges::find_if(all, [&](StudySetting const& a) { return plain_key(a.key) == key; });
    return s == all.end() ? "" : s->usual;
}

/// What the trials of a block show beside the stimulus that is varied.
struct Others {
    std::set<std::string> values;       ///< of the varied setting; "" = the scene's
    std::set<std::string> always, some; ///< other settings that differ in all trials, and in a part of them
    std::set<std::string> factors;      ///< crossed, whose level differs in a part of the trials
};

Others others_of(study::Script const& s, study::Plan const& plan, int block)
{
    study::Block const& b = s.blocks[std::size_t(block)];
    std::string const vary = plain_key(b.compare->vary);
    Others o;
    std::map<std::string, int> differing, differing_factors;
    int trials = 0;
    for (study::PlanStep const& step : plan.steps) {
        if (step.kind != study::PlanStepKind::trial || step.block != block || step.trial.is_noise) continue;
        study::Stimulus const *varied = nullptr, *other = step.trial.reference ? &*step.trial.reference : nullptr;
        for (study::Stimulus const& stimulus : step.trial.stimuli)
            (stimulus.is_varied ? varied : other) = &stimulus;
        if (varied == nullptr || other == nullptr) continue;
        ++trials;
        auto of_varied = plain(settings_of(s, b, *varied)), of_other = plain(settings_of(s, b, *other));
        auto const value = of_other.find(vary);
        o.values.insert(value == of_other.end() ? usual_value(vary) : value->second);
        of_varied.erase(vary);
        of_other.erase(vary);
        std::set<std::string> keys;
        for (auto const& settings : {of_varied, of_other})
            for (auto const& [key, unused] : settings) keys.insert(key);
        for (std::string const& key : keys)
            if (of_varied.count(key) != of_other.count(key) || of_varied[key] != of_other[key]) ++differing[key];
        for (int const f : b.cross)
            if (varied->levels[std::size_t(f)] != other->levels[std::size_t(f)])
                ++differing_factors[s.factors[std::size_t(f)].name];
    }
    for (auto const& [key, n] : differing) (n == trials ? o.always : o.some).insert(key);
    for (auto const& [name, n] : differing_factors)
        if (n < trials) o.factors.insert(name);
    return o;
}

/// Staircases that begin where there is nothing to see.
void doubt_starts(study::Block const& b, Others const& o, std::vector<std::string>& doubts)
{
    if (o.values.size() != 1 || !o.always.empty()) return;
    for (study::Procedure const& p : b.procedures)
        if (p.method == study::Method::staircase && gi::parse_finite(*o.values.begin()) == p.start)
            doubts.push_back(
                fmt::format("block '{}': procedure '{}' starts at {:g}, where the two stimuli are alike; start "
                            "where the answer is easy",
                            b.name, p.name, p.start));
}

/// Empty = nothing to doubt.
std::string doubt_of_direction(study::Block const& b, Others const& o)
{
    study::Compare const& c = *b.compare;
    if (o.values.size() != 1 || !o.always.empty() || !o.some.empty()) return {};
    auto const value = gi::parse_finite(*o.values.begin());
    if (!value) return {};
    auto const alike_at = [&](char const* where, char const* harder) {
        return fmt::format(
            "block '{}': the two stimuli become alike where {} is {} ({:g}), which is the hard end, but the "
            "script says that {} levels are harder; write harder: {}",
            b.name, c.vary, where, *value, c.harder_up ? "higher" : "lower", harder);
    };
    if (*value <= c.low && c.harder_up) return alike_at("low", "down");
    if (*value >= c.high && !c.harder_up) return alike_at("high", "up");
    bool const is_followed =
        std::ranges::any_of(b.procedures, [](auto const& p) { return study::is_adaptive(p); });
    if (*value > c.low && *value < c.high && is_followed)
        return fmt::format(
            "block '{}': {} of the other stimulus, {:g}, lies within the range {:g} to {:g}: levels on both "
            "sides of it are easy, and a procedure that follows answers expects one hard end; end the "
            "range there",
            b.name, c.vary, *value, c.low, c.high);
    return {};
}

std::string text_of(study::Script const& s, study::Block const& b, Others const& o)
{
    study::Compare const& c = *b.compare;
    if (c.factor >= 0) {
        study::Factor const& f = s.factors[std::size_t(c.factor)];
        auto const other = std::ranges::find(c.against, c.factor, &study::LevelChoice::factor);
        std::vector<std::string> names;
        for (int const level : c.levels) names.push_back(f.levels[std::size_t(level)].name);
        return fmt::format("block {} compares {} {} with {}", b.name, f.name, fmt::join(names, ", "),
                           f.levels[std::size_t(other->level)].name);
    }
    std::vector<std::string> values;
    for (std::string const& v : o.values) values.push_back(v.empty() ? "as the scene has it" : v);
    std::set<std::string> also = o.always;
    also.insert(o.some.begin(), o.some.end());
    return fmt::format("block {} compares {} {:g} to {:g} with {} ({} is harder){}", b.name, c.vary, c.low, c.high,
                       fmt::join(values, ", "), c.harder_up ? "higher" : "lower",
                       also.empty() ? "" : fmt::format("; the two also differ in {}", fmt::join(also, ", ")));
}

} // namespace

Comparisons find_comparisons(study::Script const& s, study::Plan const& plan)
{
    Comparisons found;
    for (std::size_t block = 0; block < s.blocks.size(); ++block) {
        study::Block const& b = s.blocks[block];
        if (!b.compare || b.is_broken) continue;
        Others const o = others_of(s, plan, int(block));
        if (o.values.empty()) continue; // nothing is shown beside it
        found.texts.push_back(text_of(s, b, o));
        if (b.compare->factor < 0) doubt_starts(b, o, found.doubts);
        if (b.compare->factor < 0)
            if (std::string doubt = doubt_of_direction(b, o); !doubt.empty())
                found.doubts.push_back(std::move(doubt));
        for (std::string const& name : o.factors)
            found.doubts.push_back(fmt::format(
                "block '{}': factor '{}' is crossed, but the other stimulus always has the same level of "
                "it: in a part of the trials the two differ in it; take it out of against or reference",
                b.name, name));
    }
    return found;
}

} // namespace viewer
