#include "gi/core/edit_distance.h"
#include "study/script/condition.h"
#include "study/script/read.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

/// Distinguishes keys that other tasks use from unknown keys.
void check_block_keys(gi::Yaml const& y, Task task, Mistakes& m)
{
    m.check_keys(y, "block");
    std::set<std::string> const known = block_keys(task), all = script_keys().at("block");
    std::vector<gi::InputError> told; // by check_keys
    for (auto const& [key, unused] : y.entries(told))
        if (!known.contains(key.text()) && all.contains(key.text()))
            m.add(key.error(fmt::format("'{}' does nothing in a block with task {}", key.text(), facts(task).name),
                            "it would be ignored", "remove it or choose another task"));
}

void read_sampling(gi::Yaml const& y, Pairs& p, Mistakes& m)
{
    bool is_active = false;
    m.take(y, "sampling", [&](gi::Yaml const& v) {
        is_active = v.one_of({"all", "active"}, "way to sample pairs") == 1;
    });
    for (char const* const key : {"trials", "batch"})
        if (y.has(key) && !is_active)
            m.add(y.at(key).error(fmt::format("'{}' of pairs that are all shown", key), "it would be ignored",
                                  "write sampling: active, or remove it"));
    if (!is_active) return;
    p.active_trials = 1;
    m.need(y, "trials", "40", [&](gi::Yaml const& v) { p.active_trials = int(v.integer(1, 5000)); });
    m.take(y, "batch", [&](gi::Yaml const& v) {
        p.is_tree = v.one_of({"none", "spanning_tree"}, "batch of pairs") == 1;
    });
    if (y.has("order") && p.order != PairOrder::random)
        m.add(y.at("order").error("an order of pairs that are chosen during the session",
                                  "either comes first equally often, at random", "remove it"));
    p.order = PairOrder::random;
}

/// Reports pairs that are listed twice and, for active sampling, levels that no pairs connect.
void check_pair_list(gi::Yaml const& list, Pairs const& p, Script const& s, Mistakes& m)
{
    for (std::size_t i = 0; i < p.pairs.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            bool const is_same = p.pairs[i] == p.pairs[j];
            bool const is_turned = p.pairs[i] == std::pair(p.pairs[j].second, p.pairs[j].first);
            if (is_same || (is_turned && p.order != PairOrder::fixed))
                m.add(list.items()[i].error("this pair is in the list before", "a list selects pairs",
                                            is_same ? "remove it; repeats shows all several times"
                                                    : "remove it; order: both shows both orders"));
        }
    if (!p.is_active()) return;
    auto const& levels = s.factors[std::size_t(p.factor)].levels;
    std::vector<std::size_t> group(levels.size());
    for (std::size_t i = 0; i < group.size(); ++i) group[i] = i;
    for (auto const& [a, b] : p.pairs)
        std::replace(group.begin(), group.end(), std::size_t(group[std::size_t(a)]), group[std::size_t(b)]);
    for (auto const& [a, b] : p.pairs)
        if (group[std::size_t(a)] != group[std::size_t(p.pairs[0].first)])
            return m.add(
                list.error(fmt::format("no pairs connect '{}' and '{}'",
                                       levels[std::size_t(p.pairs[0].first)].name, levels[std::size_t(a)].name),
                           "active sampling makes one scale of all levels", "add pairs between them"));
}

Pairs read_pairs(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    m.check_keys(y, "pairs");
    Pairs p;
    m.take(y, "order", [&](gi::Yaml const& v) {
        p.order = PairOrder(v.one_of({"balanced", "both", "random", "fixed"}, "order of pairs"));
    });
    read_sampling(y, p, m);
    if (!m.need(y, "factor", "visibility", [&](gi::Yaml const& v) { p.factor = read_factor(v, s); })) return p;
    if (!y.has("list")) {
        auto const levels = read_levels_of(y, s, p.factor, 2, m);
        for (std::size_t i = 0; i < levels.size(); ++i)
            for (std::size_t j = i + 1; j < levels.size(); ++j) p.pairs.emplace_back(levels[i], levels[j]);
        return p;
    }
    if (y.has("omit")) m.add(y.at("omit").error("both list and omit", "the list selects pairs", "keep one"));
    auto const items = y.at("list").items();
    std::size_t const before = m.count();
    for (gi::Yaml const& item : items)
        m.attempt([&] {
            auto const two = item.items();
            if (two.size() != 2)
                throw item.error(fmt::format("a pair of {}", two.size()), "two are compared", "[a, b]");
            p.pairs.emplace_back(read_level(two[0], s, p.factor), read_level(two[1], s, p.factor));
            if (p.pairs.back().first == p.pairs.back().second)
                throw item.error("a level paired with itself", "there is nothing to choose", "name two");
        });
    if (items.empty()) throw y.at("list").error("no pairs", "the block would be empty", "[[a, b], [a, c]]");
    if (m.count() == before) check_pair_list(y.at("list"), p, s, m);
    return p;
}

/// Reads what the varied stimulus is compared with.
Choice read_against(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    gi::Yaml const against = y.has("against") ? y.at("against") : y;
    if (y.has("against") && !against.is_text()) return read_choice(against, s, m);
    if (y.has("against") && against.text() != "reference")
        throw against.unknown("thing to compare with", {"reference"});
    if (s.reference.empty())
        throw against.error("compared with the reference, which is missing", "the other stimulus is unknown",
                            "add reference: {FACTOR: LEVEL} to the script");
    return s.reference;
}

std::string formula_name(std::string setting)
{
    std::replace_if(
        setting.begin(), setting.end(), [](char c) { return c == '.' || c == '-' || c == '+'; }, '_');
    return setting;
}

FurtherSetting read_further(gi::Yaml const& key, gi::Yaml const& y, Mistakes& m)
{
    m.check_keys(y, "also");
    FurtherSetting f;
    f.setting = key.name();
    f.name = formula_name(f.setting);
    m.take(y, "name", [&](gi::Yaml const& v) {
        f.name = v.name();
        if (f.name != formula_name(f.name))
            throw v.error("'" + f.name + "' in a formula", "its names have letters, digits and _",
                          "write another");
    });
    m.take(y, "scale", [&](gi::Yaml const& v) {
        f.scale = Scale(v.one_of({"linear", "log2", "log10", "db"}, "scale"));
    });
    bool const has_range = m.need(y, "range", "[1, 10]", [&](gi::Yaml const& range) {
        auto const ends = range.numbers(2, -1e12, 1e12);
        f.low = ends[0];
        f.high = ends[1];
        if (!(f.low < f.high)) throw range.error("a range that does not rise", "low comes first", "swap them");
        if (f.scale != Scale::linear && f.low <= 0)
            throw range.error(fmt::format("a range from {:g}", f.low), "a logarithmic scale begins above 0",
                              "start above 0 or write scale: linear");
    });
    if (!has_range) { // the missing range is reported; no value counts as outside of it
        f.low = f.scale == Scale::linear ? -1e12 : 1e-12;
        f.high = 1e12;
    }
    f.usual = from_scale(f.scale, (to_scale(f.scale, f.low) + to_scale(f.scale, f.high)) / 2);
    m.take(y, "usual", [&](gi::Yaml const& v) { f.usual = v.number(f.low, f.high); });
    return f;
}

void read_compared_factor(gi::Yaml const& y, Script const& s, Compare& c, bool knows_against, Mistakes& m)
{
    for (char const* key : {"scale", "range", "harder", "also"})
        if (y.has(key))
            m.add(y.at(key).error(fmt::format("'{}' with a factor", key), "levels of a factor have no scale",
                                  "vary a setting or remove it"));
    c.factor = read_factor(y.at("factor"), s);
    if (!knows_against) return;
    auto const other = std::find_if(c.against.begin(), c.against.end(),
                                    [&](LevelChoice const& l) { return l.factor == c.factor; });
    if (other == c.against.end())
        throw y.error(fmt::format("the stimulus that factor '{}' is compared with has no level of it",
                                  s.factors[std::size_t(c.factor)].name),
                      "the two would be the same", "add it to reference or against");
    c.levels = read_levels_of(y, s, c.factor, 1, m);
    std::erase(c.levels, other->level);
    if (c.levels.empty())
        throw y.error("no level except the reference", "there is nothing to compare", "omit fewer");
}

/// If the range is wrong, it is left wide, so that nothing else seems to be outside of it.
void read_varied_range(gi::Yaml const& y, Compare& c, Mistakes& m)
{
    if (y.has("omit")) m.add(y.at("omit").error("'omit' without a factor", "it omits levels", "remove it"));
    m.take(y, "vary", [&](gi::Yaml const& v) { c.vary = v.name(); });
    m.take(y, "scale", [&](gi::Yaml const& v) {
        std::vector<std::string> const known{"linear", "log2", "log10", "db"};
        c.scale = Scale(v.one_of(known, "scale"));
    });
    c.low = -1e12;
    c.high = 1e12;
    m.need(y, "range", "[64, 16384]", [&](gi::Yaml const& v) {
        auto const range = v.items();
        if (range.size() != 2) throw v.error("not two numbers", "a range has two ends", "write [64, 16384]");
        double const low = range[0].number(-1e12, 1e12), high = range[1].number(-1e12, 1e12);
        if (!(low < high)) throw v.error("a range that does not rise", "low comes first", "swap them");
        if (c.scale != Scale::linear && low <= 0)
            throw range[0].error(fmt::format("a range from {:g}", low), "a logarithmic scale begins above 0",
                                 "start above 0 or write scale: linear");
        c.low = low;
        c.high = high;
    });
    m.take(y, "also", [&](gi::Yaml const& v) {
        for (auto const& [key, value] : m.entries(v))
            m.attempt([&, k = key, further = value] {
                c.also.push_back(read_further(k, further, m));
                for (std::size_t i = 0; i + 1 < c.also.size(); ++i)
                    if (c.also[i].name == c.also.back().name)
                        throw k.error("two settings named '" + c.also[i].name + "'",
                                      "the formula could not tell them", "give one a name");
            });
    });
    m.need(y, "harder", "up", [&](gi::Yaml const& v) {
        c.harder_up = v.one_of({"up", "down"}, "direction") == 0;
    });
}

/// Adds settings of `with` that the procedure sets anyway.
void check_with(gi::Yaml const& with, Compare const& c, Mistakes& m)
{
    std::vector<gi::InputError> told; // by read_patch
    for (auto const& [key, unused] : with.entries(told)) {
        auto const is_it = [k = plain_key(key.text())](std::string const& s) { return plain_key(s) == k; };
        if (is_it(c.vary) ||
            std::any_of(c.also.begin(), c.also.end(), [&](FurtherSetting const& f) { return is_it(f.setting); }))
            m.add(key.error(fmt::format("'with' sets '{}', whose level a procedure chooses", key.text()),
                            "one overrides the other", "remove it"));
    }
}

Compare read_compare(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    m.check_keys(y, "compare");
    Compare c;
    if (y.has("vary") == y.has("factor"))
        throw y.error("compare needs either vary or factor", "it defines the stimuli",
                      "write vary: SETTING or factor: FACTOR");
    bool const knows_against = m.attempt([&] { c.against = read_against(y, s, m); });
    m.take(y, "with", [&](gi::Yaml const& v) { c.with = read_patch(v, m); });
    if (y.has("factor"))
        read_compared_factor(y, s, c, knows_against, m);
    else
        read_varied_range(y, c, m);
    if (y.at("with").is_map()) check_with(y.at("with"), c, m);
    return c;
}

double read_vary_level(gi::Yaml const& y, Compare const& c)
{
    std::string const word = y.text();
    if (word == "easiest") return easiest(c);
    if (word == "hardest") return c.harder_up ? c.high : c.low;
    if (word == "min") return c.low;
    if (word == "max") return c.high;
    return read_number_or(y, {"easiest", "hardest", "min", "max"}, c.low, c.high);
}

/// Of a block with mistakes, what they leave known.
Catch read_catch(gi::Yaml const& y, Block const& b, Script const& s, Mistakes& m)
{
    m.check_keys(y, "catch");
    Catch k;
    k.place = y.place();
    m.need(y, "every", "12", [&](gi::Yaml const& v) { k.every = int(v.integer(2, 100000)); });
    bool const varies = b.compare && b.compare->factor < 0;
    bool const is_preference = b.pairs && b.pairs->factor >= 0 && presented_orders(b.task, false).empty();
    bool const has_noise = b.task == Task::yes_no || b.task == Task::same_different;
    if (b.is_broken && !varies && !is_preference) return k;
    if (y.has("level") != varies || y.has("better") != is_preference || y.has("worse") != is_preference)
        throw y.error("these catch trials have no correct answer",
                      varies          ? "the level of the varied setting defines it"
                      : is_preference ? "'better' and 'worse' define it"
                                      : "no level of a factor is obvious to everybody",
                      varies          ? "write level: easiest"
                      : is_preference ? "write better: LEVEL, worse: LEVEL"
                                      : "remove them");
    if (is_preference) {
        m.attempt([&] { k.better = read_level(y.at("better"), s, b.pairs->factor); });
        m.attempt([&] { k.worse = read_level(y.at("worse"), s, b.pairs->factor); });
        if (k.better == k.worse && k.better >= 0)
            throw y.error("better and worse are the same", "there is nothing to find", "name two");
    } else if (has_noise && y.at("level").is_text() && y.at("level").text() == "none") {
        k.kind = CatchLevel::absent;
    } else if (varies) {
        k.level = read_vary_level(y.at("level"), *b.compare);
    }
    return k;
}

void read_practice(gi::Yaml const& y, Block& b, Mistakes& m)
{
    m.check_keys(y, "practice");
    m.need(y, "trials", "4", [&](gi::Yaml const& v) { b.practice.trials = int(v.integer(1, 10000)); });
    bool const has_answer = !presented_orders(b.task, false).empty();
    b.practice.has_feedback = has_answer;
    m.take(y, "feedback", [&](gi::Yaml const& v) {
        b.practice.has_feedback = v.boolean();
        if (b.practice.has_feedback && !has_answer)
            throw v.error(fmt::format("feedback on {}", facts(b.task).name), "no answer is right", "write false");
    });
    if (b.is_broken && !b.compare) return; // what is varied is not known
    m.take(y, "level", [&](gi::Yaml const& v) {
        if (!b.compare || b.compare->factor >= 0)
            throw v.error("a level although nothing is varied", "it would be ignored", "remove it");
        b.practice.level = read_vary_level(v, *b.compare);
    });
}

void read_nest(gi::Yaml const& key, gi::Yaml const& y, Script const& s, Block& b, Mistakes& m)
{
    auto const is_crossed = [&](int f) { return std::find(b.cross.begin(), b.cross.end(), f) != b.cross.end(); };
    m.check_keys(y, "nest");
    Nest n;
    m.attempt([&] { n.factor = read_factor(key, s); });
    m.need(y, "in", "scene", [&](gi::Yaml const& v) { n.within = read_factor(v, s); });
    if (n.factor < 0 || n.within < 0) return; // told
    gi::Yaml const in = y.at("in");
    if (!is_crossed(n.within) || is_crossed(n.factor) || !b.only[std::size_t(n.factor)].empty())
        throw key.error(fmt::format("'{}' cannot be nested in '{}'", key.text(), in.text()),
                        "the outer factor must be crossed and the inner one neither crossed nor under 'only'",
                        fmt::format("write cross: [{}]", in.text()));
    n.levels.resize(s.factors[std::size_t(n.within)].levels.size());
    bool is_told = false;
    for (auto const& [outer, inner] : m.entries(y.needed("levels", "{arches: [left, right]}")))
        is_told |= !m.attempt([&, o = outer, i = inner] {
            int const within = read_level(o, s, n.within);
            for (gi::Yaml const& level : i.one_or_more())
                n.levels[std::size_t(within)].push_back(read_level(level, s, n.factor));
        });
    for (int const outer : crossed_levels(s, b, n.within))
        if (n.levels[std::size_t(outer)].empty() && !is_told)
            m.add(y.error(fmt::format("'{}' has no levels within {}", key.text(),
                                      s.factors[std::size_t(n.within)].levels[std::size_t(outer)].name),
                          "that part of the block would be empty", "name some"));
    b.nest.push_back(n);
}

/// Reads cross, nest, only.
void read_conditions(gi::Yaml const& y, Script const& s, Block& b, Mistakes& m)
{
    b.only.resize(s.factors.size());
    if (y.has("only"))
        for (auto const& [key, value] : m.entries(y.at("only")))
            m.attempt([&, k = key, v = value] {
                int const f = read_factor(k, s);
                auto const levels = v.one_or_more();
                for (gi::Yaml const& level : levels)
                    m.attempt([&] { b.only[std::size_t(f)].push_back(read_level(level, s, f)); });
                if (levels.empty()) throw v.error("no levels", "the block would be empty", "name one");
            });
    m.take(y, "cross", [&](gi::Yaml const& v) {
        for (gi::Yaml const& name : v.one_or_more())
            m.attempt([&] {
                int const f = read_factor(name, s);
                if (std::find(b.cross.begin(), b.cross.end(), f) != b.cross.end())
                    throw name.error("'" + name.text() + "' is crossed twice", "once is enough", "remove one");
                b.cross.push_back(f);
            });
    });
    if (!y.has("nest")) return;
    for (auto const& [key, value] : m.entries(y.at("nest")))
        m.attempt([&, k = key, v = value] { read_nest(k, v, s, b, m); });
}

bool has_reference(Script const& s, int factor)
{
    return std::any_of(s.reference.begin(), s.reference.end(), [&](LevelChoice c) { return c.factor == factor; });
}

/// Reads what the task shows, without procedures. Returns whether it is known.
bool read_shown(gi::Yaml const& y, Script const& s, Block& b, Mistakes& m)
{
    TaskFacts const& f = facts(b.task);
    bool const needs_one = f.takes_pairs || f.takes_compare;
    if (needs_one && y.has("pairs") == y.has("compare")) {
        std::string const what = f.takes_pairs && f.takes_compare ? "either pairs or compare"
                                 : f.takes_pairs                  ? "pairs"
                                                                  : "compare";
        throw y.error(fmt::format("block '{}' needs {}", b.name, what), "it defines the stimuli",
                      f.takes_pairs ? "write pairs: {factor: FACTOR}" : "write compare: {factor: FACTOR}");
    }
    bool is_known = true;
    if (f.takes_pairs) is_known &= m.take(y, "pairs", [&](gi::Yaml const& v) { b.pairs = read_pairs(v, s, m); });
    if (f.takes_compare)
        is_known &= m.take(y, "compare", [&](gi::Yaml const& v) { b.compare = read_compare(v, s, m); });
    if (b.task == Task::ranking)
        m.need(y, "rank", "{factor: FACTOR}", [&](gi::Yaml const& rank) {
            m.check_keys(rank, "rank");
            b.rank = read_factor(rank.needed("factor", "visibility"), s);
            b.rank_levels = read_levels_of(rank, s, b.rank, 2, m);
            if (b.rank_levels.size() > 9)
                throw rank.error(fmt::format("{} to rank", b.rank_levels.size()),
                                 "the order is typed as digits 1 to 9", "omit some");
        });
    if (b.task == Task::pair_with_reference && b.pairs && b.pairs->factor >= 0 &&
        !has_reference(s, b.pairs->factor))
        m.add(y.at("pairs").error(
            fmt::format("factor '{}' has no reference", s.factors[std::size_t(b.pairs->factor)].name),
            "the task shows it with the pair", "add it to reference"));
    bool const is_preference = f.takes_pairs && !f.takes_compare;
    if (b.pairs && b.pairs->is_active() && !is_preference)
        m.add(y.at("pairs").error(fmt::format("active sampling of pairs in task {}", f.name),
                                  "it is for preferences, whose answers make a scale",
                                  "use it in pair or pair_with_reference"));
    if (b.pairs && b.pairs->is_active() && y.has("repeats"))
        m.add(y.at("repeats").error("'repeats' of pairs that are chosen during the session",
                                    "their number is 'trials' of pairs", "remove it"));
    if (b.task == Task::questionnaire)
        m.need(y, "questionnaire", "ssq",
               [&](gi::Yaml const& v) { b.questionnaire = read_questionnaire_name(v, s); });
    return is_known;
}

void read_procedures(gi::Yaml const& y, Block& b, Mistakes& m)
{
    bool const varies = b.compare && b.compare->factor < 0;
    if (y.has("procedure") && y.has("interleave"))
        throw y.at("procedure").error("both procedure and interleave", "interleave has them all", "keep one");
    if (varies != (y.has("procedure") || y.has("interleave")))
        throw y.error(varies ? fmt::format("no procedure varies '{}'", b.compare->vary)
                             : "a procedure without a setting to vary",
                      "a procedure chooses levels of the setting in compare",
                      varies ? "add procedure: {method: constant, levels: [...]}"
                             : "write compare: {vary: SETTING}");
    m.take(y, "procedure",
           [&](gi::Yaml const& v) { b.procedures.push_back(read_procedure(v, *b.compare, b.task, m)); });
    if (!y.has("interleave")) return;
    auto const items = y.at("interleave").items();
    for (gi::Yaml const& item : items)
        m.attempt([&] {
            b.procedures.push_back(read_procedure(item, *b.compare, b.task, m));
            for (std::size_t i = 0; i + 1 < b.procedures.size(); ++i)
                if (b.procedures[i].name == b.procedures.back().name)
                    throw item.error("two procedures named '" + b.procedures[i].name + "'",
                                     "records could not distinguish them", "give each a name");
        });
    if (items.empty())
        throw y.at("interleave").error("nothing to interleave", "the block would be empty", "name procedures");
}

void read_scales(gi::Yaml const& y, Script const& s, Block& b, Mistakes& m)
{
    if (b.task == Task::rating)
        m.need(y, "scale", "{min: 1, max: 7}", [&](gi::Yaml const& v) { b.scale = read_scale(v, m); });
    if (b.task == Task::free_walk)
        m.take(y, "duration_s", [&](gi::Yaml const& v) { b.duration_s = v.number(1, 36000); });
    if (b.task != Task::magnitude) return;
    m.take(y, "modulus", [&](gi::Yaml const& v) { b.magnitude.modulus = v.number(1e-6, 1e9); });
    m.take(y, "standard", [&](gi::Yaml const& v) { b.magnitude.standard = read_choice(v, s, m); });
    if (y.has("modulus") != y.has("standard"))
        m.add(y.error("'modulus' and 'standard' belong together", "the modulus is the number of the standard",
                      "give both or none"));
}

void read_presentation(gi::Yaml const& y, Block& b, Mistakes& m)
{
    m.take(y, "presentation", [&](gi::Yaml const& v) {
        b.is_sequential = v.one_of({"simultaneous", "sequential"}, "presentation") == 1;
    });
    bool const shows_several = facts(b.task).takes_pairs || b.task == Task::two_interval ||
                               b.task == Task::ranking || b.magnitude.modulus > 0;
    if (b.is_sequential && shows_several && !b.timing.stimulus_ms)
        m.add(y.error(fmt::format("block '{}' shows stimuli one after another, each until the answer", b.name),
                      "there is only one answer, after all of them", "add stimulus_ms: 2000"));
}

void read_rest_of_block(gi::Yaml const& y, Script const& s, Block& b, Mistakes& m)
{
    m.take(y, "prompt", [&](gi::Yaml const& v) { b.prompt = v.text(); });
    m.take(y, "instructions", [&](gi::Yaml const& v) { b.instructions = v.text(); });
    m.take(y, "repeats", [&](gi::Yaml const& v) { b.repeats = int(v.integer(1, 10000)); });
    m.take(y, "shuffle", [&](gi::Yaml const& v) {
        b.shuffle = Shuffle(v.one_of({"all", "within_repeats", "none"}, "way to shuffle"));
    });
    m.take(y, "feedback", [&](gi::Yaml const& v) { b.has_feedback = v.boolean(); });
    m.take(y, "ties", [&](gi::Yaml const& v) { b.may_tie = v.boolean(); });
    m.take(y, "break_every", [&](gi::Yaml const& v) { b.break_every = int(v.integer(1, 100000)); });
    m.take(y, "break_s", [&](gi::Yaml const& v) { b.break_s = v.number(0, 3600); });
    m.take(y, "camera", [&](gi::Yaml const& v) { b.camera = v.text(); });
    m.take(y, "stimuli", [&](gi::Yaml const& v) {
        b.stimuli = Stimuli(v.one_of({"live", "prepared"}, "way to make stimuli"));
    });
    m.take(y, "settings", [&](gi::Yaml const& v) {
        for (auto const& [key, value] : read_patch(v, m)) set_setting(b.settings, key, value);
    });
    m.take(y, "gaze", [&](gi::Yaml const& v) { read_gaze(v, b.gaze, m); });
    m.take(y, "cues", [&](gi::Yaml const& v) { b.cues = read_cues(v, s, m); });
    m.take(y, "constraints", [&](gi::Yaml const& v) {
        for (gi::Yaml const& item : v.items())
            m.attempt([&] {
                std::size_t const before = m.count();
                Constraint const c = read_constraint(item, s, m);
                if (m.count() == before) b.constraints.push_back(c);
            });
    });
}

/// The index in kTasks. A misspelt task is reported, and the nearest one taken.
std::size_t read_task(gi::Yaml const& y, Mistakes& m)
{
    std::vector<std::string> names;
    for (Task const t : kTasks) names.emplace_back(facts(t).name);
    auto const found = std::find(names.begin(), names.end(), y.text());
    if (found != names.end()) return std::size_t(found - names.begin());
    auto const nearest = gi::nearest_word(y.text(), names);
    if (!nearest) throw y.unknown("task", names);
    m.add(y.unknown("task", names));
    return std::size_t(std::ranges::find(names, *nearest) - names.begin());
}

} // namespace

Block read_block(gi::Yaml const& name, gi::Yaml const& y, Script const& s, Mistakes& m)
{
    Block b;
    b.name = name.text();
    b.place = name.place();
    b.only.resize(s.factors.size());
    b.timing = s.defaults.timing;
    b.camera = s.defaults.camera;
    b.stimuli = s.defaults.stimuli;
    b.settings = s.defaults.settings;
    b.gaze = s.defaults.gaze;
    b.cues = s.defaults.cues;
    m.attempt([&] { name.name(); });
    b.knows_task = m.need(y, "task", "rating", [&](gi::Yaml const& v) { b.task = kTasks[read_task(v, m)]; });
    if (!b.knows_task) {
        b.is_broken = true;
        m.check_keys(y, "block");
        return b;
    }
    check_block_keys(y, b.task, m);
    b.is_sequential = facts(b.task).is_sequential;
    read_trial_timing(y, b.timing, m);
    std::size_t const before = m.grave();
    read_conditions(y, s, b, m);
    bool is_known = false;
    m.attempt([&] { is_known = read_shown(y, s, b, m); });
    if (is_known) m.attempt([&] { read_procedures(y, b, m); });
    b.is_broken = m.grave() > before;
    read_scales(y, s, b, m);
    read_rest_of_block(y, s, b, m);
    read_presentation(y, b, m);
    if (block_keys(b.task).contains("catch"))
        m.take(y, "catch", [&](gi::Yaml const& v) {
            std::size_t const before_catch = m.count();
            Catch const k = read_catch(v, b, s, m);
            if (m.count() == before_catch) b.catches = k;
        });
    m.take(y, "practice", [&](gi::Yaml const& v) { read_practice(v, b, m); });
    bool const is_many = b.compare && !b.compare->also.empty();
    if (is_many && b.stimuli == Stimuli::prepared)
        m.add(y.error("prepared stimuli of several varied settings", "there would be too many",
                      "write stimuli: live"));
    for (Procedure const& p : b.procedures)
        if (is_many && p.method != Method::questplus && !b.is_broken)
            m.add(ScriptError(s.file, p.place,
                              fmt::format("procedure '{}' varies one setting, and compare.also has more", p.name),
                              "they would keep their usual levels", "use questplus, or remove also"));
    return b;
}

} // namespace study
