#include "gi/core/edit_distance.h"
#include "study/script/condition.h"
#include "study/script/read.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace study {
namespace {

void check_setting_key(gi::Yaml const& key)
{
    std::string const s = key.name();
    if (!std::isalpha(static_cast<unsigned char>(s.front())) || s.back() == '.' ||
        s.find("..") != std::string::npos)
        throw key.error("'" + s + "' is no setting", "settings are words separated by dots", "such as gi.points");
}

std::vector<std::string> names_of(std::vector<FactorLevel> const& levels)
{
    std::vector<std::string> names;
    for (FactorLevel const& l : levels) names.push_back(l.name);
    return names;
}

} // namespace

double read_number_or(gi::Yaml const& y, std::vector<std::string> const& words, double low, double high)
{
    if (y.is_text() && !y.text().empty() && std::isalpha(static_cast<unsigned char>(y.text().front())))
        throw y.error(
            fmt::format("'{}' is neither a number nor {}", y.text().substr(0, 64), fmt::join(words, ", ")),
            "nothing else is known here", gi::suggest(y.text(), words, "write a number, or a word of these"));
    return y.number(low, high);
}

Patch read_patch(gi::Yaml const& y, Mistakes& m)
{
    Patch patch;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] {
            check_setting_key(k);
            for (auto const& [other, unused] : patch)
                if (plain_key(other) == plain_key(k.text()))
                    throw k.error(fmt::format("'{}' and '{}' are one setting", other, k.text()),
                                  "only one of them can count", "remove one");
            std::string const text = v.text();
            if (text.find_first_of("\t\n\r") != std::string::npos)
                throw v.error(v.path() + " is more than a line", "a setting is one word or number", "shorten it");
            patch.emplace_back(k.text(), text);
        });
    return patch;
}

namespace {

/// Adds a level even if its settings are wrong, so that it is known where its name occurs.
void read_level_list(gi::Yaml const& key, gi::Yaml const& list, Factor& factor, Mistakes& m)
{
    m.attempt([&] { check_setting_key(key); });
    for (gi::Yaml const& level : list.items())
        m.attempt([&] { factor.levels.push_back({level.name(), {{factor.name, level.name()}}}); });
}

Factor read_factor_levels(gi::Yaml const& key, gi::Yaml const& value, std::vector<Factor> const& before_it,
                          Mistakes& m)
{
    Factor factor{key.name(), {}, key.place()};
    for (char const* reserved : {"pair", "answer", "procedure", "do"})
        if (factor.name == reserved)
            m.add(key.error("a factor named '" + factor.name + "'", "the word has another meaning in scripts",
                            "choose another name"));
    for (Factor const& other : before_it)
        if ("factor_" + other.name == factor.name || "factor_" + factor.name == other.name)
            m.add(key.error(fmt::format("factors '{}' and '{}'", other.name, factor.name),
                            "tables could have one column name for both", "rename one"));
    std::size_t const before = m.count();
    if (value.is_list())
        read_level_list(key, value, factor, m);
    else
        for (auto const& [name, patch] : m.entries(value))
            m.attempt([&, n = name, p = patch] {
                factor.levels.push_back({n.name(), {}});
                factor.levels.back().settings = read_patch(p, m);
            });
    auto names = names_of(factor.levels);
    for (char const* const missing : {"NA", "NaN", "nan", "-NaN", "-nan", "NULL", "null", "None"})
        if (std::find(names.begin(), names.end(), missing) != names.end())
            m.add(value.error(fmt::format("a level named '{}'", missing),
                              "R and pandas read it as a missing value", "choose another name"));
    std::sort(names.begin(), names.end());
    if (auto const twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
        m.add(value.error(fmt::format("level '{}' twice in {}", *twice, factor.name),
                          "they could not be distinguished", "remove one"));
    bool const is_told = names.empty() && m.count() > before;
    if ((names.empty() || names.size() > 1000) && !is_told)
        m.add(value.error(fmt::format("factor '{}' has {} levels", factor.name, names.size()),
                          "1 to 1000 are allowed", names.empty() ? "add some" : "split it"));
    if (factor.levels.empty()) factor.levels.push_back({}); // told; reading goes on
    return factor;
}

} // namespace

std::vector<Factor> read_factors(gi::Yaml const& y, Mistakes& m)
{
    std::vector<Factor> factors;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] { factors.push_back(read_factor_levels(k, v, factors, m)); });
    return factors;
}

int read_factor(gi::Yaml const& name, Script const& s)
{
    std::vector<std::string> known;
    for (Factor const& f : s.factors) known.push_back(f.name);
    return name.one_of(known, "factor");
}

int read_level(gi::Yaml const& name, Script const& s, int factor)
{
    Factor const& f = s.factors[std::size_t(factor)];
    return name.one_of(names_of(f.levels), "level of factor '" + f.name + "'");
}

int read_questionnaire_name(gi::Yaml const& name, Script const& s)
{
    std::vector<std::string> known;
    for (Questionnaire const& q : s.questionnaires) known.push_back(q.name);
    return name.one_of(known, "questionnaire");
}

Choice read_choice(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    Choice choice;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] {
            int const factor = read_factor(k, s);
            choice.push_back({factor, 0}); // in place of an unknown level
            choice.back().level = read_level(v, s, factor);
        });
    return choice;
}

std::vector<int> read_levels_of(gi::Yaml const& y, Script const& s, int factor, std::size_t least, Mistakes& m)
{
    Factor const& f = s.factors[std::size_t(factor)];
    std::vector<bool> omitted(f.levels.size());
    if (y.has("omit"))
        for (gi::Yaml const& name : y.at("omit").one_or_more())
            m.attempt_aside([&] { omitted[std::size_t(read_level(name, s, factor))] = true; });
    std::vector<int> levels;
    for (std::size_t i = 0; i < f.levels.size(); ++i)
        if (!omitted[i]) levels.push_back(int(i));
    if (levels.size() < least)
        throw y.error(
            fmt::format("factor '{}' leaves {} of its {} levels here", f.name, levels.size(), f.levels.size()),
            fmt::format("at least {} are needed", least), "omit fewer or add levels");
    return levels;
}

void read_trial_timing(gi::Yaml const& y, TrialTiming& timing, Mistakes& m)
{
    constexpr double kHour_ms = 3600000;
    m.take(y, "warmup_frames", [&](gi::Yaml const& v) { timing.warmup_frames = int(v.integer(0, 100000)); });
    for (auto const& [key, value] :
         {std::pair{"isi_ms", &timing.isi_ms}, {"iti_ms", &timing.iti_ms}, {"feedback_ms", &timing.feedback_ms}})
        m.take(y, key, [into = value](gi::Yaml const& v) { *into = v.number(0, kHour_ms); });
    auto const optional = [&](char const* key, char const* word, std::optional<double>& value) {
        m.take(y, key, [&](gi::Yaml const& v) {
            if (v.is_text() && v.text() == word) return value.reset();
            value = kHour_ms; // placeholder after a mistake, so that a missing value is not reported as well
            value = read_number_or(v, {word}, 1, kHour_ms);
        });
    };
    optional("stimulus_ms", "until_response", timing.stimulus_ms);
    optional("timeout_ms", "none", timing.timeout_ms);
    m.take(y, "min_response_ms", [&](gi::Yaml const& v) { timing.min_response_ms = v.number(0, kHour_ms); });
    optional("max_response_ms", "none", timing.max_response_ms);
    double const latest =
        std::min(timing.max_response_ms.value_or(kHour_ms), timing.timeout_ms.value_or(kHour_ms));
    for (char const* const key : {"min_response_ms", "max_response_ms", "timeout_ms"})
        if (y.has(key) && timing.min_response_ms >= latest) {
            m.add(y.at(key).error(
                fmt::format("answers later than {:g} ms and before {:g} ms", timing.min_response_ms, latest),
                "no answer could count", "lower min_response_ms, or raise the other limit"));
            break;
        }
    optional("expected_response_ms", "usual", timing.expected_response_ms);
}

RatingScale read_scale(gi::Yaml const& y, Mistakes& m)
{
    m.check_keys(y, "scale");
    RatingScale scale;
    bool has_ends = m.need(y, "min", "1", [&](gi::Yaml const& v) { scale.low = v.number(-1e6, 1e6); });
    has_ends &= m.need(y, "max", "7", [&](gi::Yaml const& v) { scale.high = v.number(-1e6, 1e6); });
    bool const has_step = m.take(y, "step", [&](gi::Yaml const& v) { scale.step = v.number(1e-6, 1e6); });
    if (has_ends && !(scale.low < scale.high))
        throw y.error(fmt::format("a scale from {:g} to {:g}", scale.low, scale.high), "min comes first",
                      "raise max");
    double const steps = (scale.high - scale.low) / scale.step;
    if (has_ends && has_step && (!(steps >= 1 && steps <= 1e5) || std::abs(steps - std::round(steps)) > 1e-6))
        throw y.error(fmt::format("a scale from {:g} to {:g} by {:g}", scale.low, scale.high, scale.step),
                      "it needs 2 to 100001 values, the last of them max", "change max or step");
    if (y.has("labels") && has_ends)
        for (auto const& [key, value] : m.entries(y.at("labels")))
            m.attempt(
                [&, k = key, v = value] { scale.labels.emplace_back(k.number(scale.low, scale.high), v.text()); });
    return scale;
}

Constraint read_constraint(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    check_keys(y, "constraint");
    Constraint c;
    c.place = y.place();
    auto const subject = [&](gi::Yaml const& name) {
        constexpr int kOthers = 3;
        std::vector<std::string> known{"pair", "answer", "procedure"};
        for (Factor const& f : s.factors) known.push_back(f.name);
        int const i = name.one_of(known, "subject of a rule");
        c.subject = i == 0   ? Subject::pair
                    : i == 1 ? Subject::answer
                    : i == 2 ? Subject::procedure
                             : Subject::factor;
        if (i >= kOthers) c.factor = i - kOthers;
    };
    bool const is_repeat = y.has("no_repeat"), is_run = y.has("max_run"), is_gap = y.has("min_gap"),
               is_after = y.has("never_after"), is_first = y.has("not_first");
    bool const has_subject = y.has("of");
    if (int(is_repeat || is_run) + is_gap + is_after + is_first != 1 ||
        has_subject != ((is_run && !is_repeat) || is_gap))
        throw y.error(
            "this is no constraint", "a constraint has one rule",
            "write {no_repeat: F}, {no_repeat: F, max_run: 2}, {max_run: 2, of: F}, {min_gap: 2, of: F}, "
            "{never_after: {F: [a, b]}} or {not_first: {F: a}}");
    m.take(y, "of", subject);
    m.take(y, "no_repeat", subject);
    m.take(y, "max_run", [&](gi::Yaml const& v) { c.count = int(v.integer(1, 100000)); });
    if (is_gap) c.kind = RuleKind::min_gap;
    m.take(y, "min_gap", [&](gi::Yaml const& v) { c.count = int(v.integer(1, 100000)); });
    if (!is_after && !is_first) return c;
    gi::Yaml const map = y.at(is_after ? "never_after" : "not_first");
    auto const entries = map.entries();
    if (entries.size() != 1)
        throw map.error("not one factor", "a rule has one factor", "write one constraint for each");
    c.factor = read_factor(entries[0].first, s);
    auto const levels = entries[0].second.one_or_more();
    if (levels.size() != (is_after ? 2u : 1u))
        throw entries[0].second.error(fmt::format("{} levels", levels.size()),
                                      is_after ? "the first and the one that must not follow it are needed"
                                               : "one is needed",
                                      is_after ? "write [a, b]" : "write one constraint for each");
    c.kind = is_after ? RuleKind::never_after : RuleKind::not_first;
    if (is_after) m.attempt([&] { c.from = read_level(levels[0], s, c.factor); });
    m.attempt([&] { c.to = read_level(levels.back(), s, c.factor); });
    return c;
}

} // namespace study
