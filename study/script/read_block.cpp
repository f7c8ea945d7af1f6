#include "study/script/condition.h"
#include "study/script/read.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

/// Distinguishes keys that other tasks use from unknown keys.
void check_block_keys(gi::Yaml const& y, Task task)
{
    check_keys(y, "block");
    std::set<std::string> const known = block_keys(task);
    for (auto const& [key, unused] : y.entries())
        if (!known.contains(key.text()))
            throw key.error(fmt::format("'{}' does nothing in a block with task {}", key.text(), facts(task).name),
                            "it would be ignored", "remove it or choose another task");
}

Pairs read_pairs(gi::Yaml const& y, Script const& s)
{
    check_keys(y, "pairs");
    Pairs p;
    p.factor = read_factor(y.needed("factor", "visibility"), s);
    if (y.has("order"))
        p.order = PairOrder(y.at("order").one_of({"balanced", "both", "random", "fixed"}, "order of pairs"));
    if (!y.has("list")) {
        auto const levels = read_levels_of(y, s, p.factor, 2);
        for (std::size_t i = 0; i < levels.size(); ++i)
            for (std::size_t j = i + 1; j < levels.size(); ++j) p.pairs.emplace_back(levels[i], levels[j]);
        return p;
    }
    if (y.has("omit")) throw y.at("omit").error("both list and omit", "the list selects pairs", "keep one");
    for (gi::Yaml const& item : y.at("list").items()) {
        auto const two = item.items();
        if (two.size() != 2)
            throw item.error(fmt::format("a pair of {}", two.size()), "two are compared", "[a, b]");
        p.pairs.emplace_back(read_level(two[0], s, p.factor), read_level(two[1], s, p.factor));
        if (p.pairs.back().first == p.pairs.back().second)
            throw item.error("a level paired with itself", "there is nothing to choose", "name two");
    }
    if (p.pairs.empty()) throw y.at("list").error("no pairs", "the block would be empty", "[[a, b], [a, c]]");
    return p;
}

Compare read_compare(gi::Yaml const& y, Script const& s)
{
    check_keys(y, "compare");
    Compare c;
    if (y.has("vary") == y.has("factor"))
        throw y.error("compare needs either vary or factor", "it defines the stimuli",
                      "write vary: SETTING or factor: FACTOR");
    gi::Yaml const against = y.has("against") ? y.at("against") : y;
    if (y.has("against") && !against.is_text())
        c.against = read_choice(against, s);
    else if (y.has("against") && against.text() != "reference")
        throw against.unknown("thing to compare with", {"reference"});
    else if (s.reference.empty())
        throw against.error("compared with the reference, which is missing", "the other stimulus is unknown",
                            "add reference: {FACTOR: LEVEL} to the script");
    else
        c.against = s.reference;
    if (y.has("with")) c.with = read_patch(y.at("with"));
    if (y.has("factor")) {
        for (char const* key : {"scale", "range", "harder"})
            if (y.has(key))
                throw y.at(key).error(fmt::format("'{}' with a factor", key), "levels of a factor have no scale",
                                      "vary a setting or remove it");
        c.factor = read_factor(y.at("factor"), s);
        auto const other = std::find_if(c.against.begin(), c.against.end(),
                                        [&](LevelChoice const& l) { return l.factor == c.factor; });
        if (other == c.against.end())
            throw y.error(fmt::format("the stimulus that factor '{}' is compared with has no level of it",
                                      s.factors[std::size_t(c.factor)].name),
                          "the two would be the same", "add it to reference or against");
        c.levels = read_levels_of(y, s, c.factor, 1);
        std::erase(c.levels, other->level);
        if (c.levels.empty())
            throw y.error("no level except the reference", "there is nothing to compare", "omit fewer");
        return c;
    }
    if (y.has("omit")) throw y.at("omit").error("'omit' without a factor", "it omits levels", "remove it");
    c.vary = y.at("vary").name();
    if (y.has("scale")) {
        std::vector<std::string> const known{"linear", "log2", "log10", "db"};
        c.scale = Scale(y.at("scale").one_of(known, "scale"));
    }
    auto const range = y.needed("range", "[64, 16384]").items();
    if (range.size() != 2)
        throw y.at("range").error("not two numbers", "a range has two ends", "write [64, 16384]");
    c.low = range[0].number(-1e12, 1e12);
    c.high = range[1].number(-1e12, 1e12);
    if (!(c.low < c.high)) throw y.at("range").error("a range that does not rise", "low comes first", "swap them");
    if (c.scale != Scale::linear && c.low <= 0)
        throw range[0].error(fmt::format("a range from {:g}", c.low), "a logarithmic scale begins above 0",
                             "start above 0 or write scale: linear");
    c.harder_up = y.needed("harder", "up").one_of({"up", "down"}, "direction") == 0;
    return c;
}

double read_vary_level(gi::Yaml const& y, Compare const& c)
{
    std::string const word = y.text();
    if (word == "easiest") return easiest(c);
    if (word == "hardest") return c.harder_up ? c.high : c.low;
    if (word == "min") return c.low;
    if (word == "max") return c.high;
    return y.number(c.low, c.high);
}

Catch read_catch(gi::Yaml const& y, Block const& b, Script const& s)
{
    check_keys(y, "catch");
    Catch k;
    k.place = y.place();
    k.every = y.needed("every", "12").integer(2, 100000);
    bool const varies = b.compare && b.compare->factor < 0;
    bool const is_preference = b.pairs && presented_orders(b.task, false).empty();
    bool const has_noise = b.task == Task::yes_no || b.task == Task::same_different;
    if (y.has("level") != varies || y.has("better") != is_preference || y.has("worse") != is_preference)
        throw y.error("these catch trials have no correct answer",
                      varies          ? "the level of the varied setting defines it"
                      : is_preference ? "'better' and 'worse' define it"
                                      : "no level of a factor is obvious to everybody",
                      varies          ? "write level: easiest"
                      : is_preference ? "write better: LEVEL, worse: LEVEL"
                                      : "remove them");
    if (is_preference) {
        k.better = read_level(y.at("better"), s, b.pairs->factor);
        k.worse = read_level(y.at("worse"), s, b.pairs->factor);
        if (k.better == k.worse)
            throw y.error("better and worse are the same", "there is nothing to find", "name two");
    } else if (has_noise && y.at("level").is_text() && y.at("level").text() == "none") {
        k.kind = CatchLevel::absent;
    } else {
        k.level = read_vary_level(y.at("level"), *b.compare);
    }
    return k;
}

void read_practice(gi::Yaml const& y, Block& b)
{
    check_keys(y, "practice");
    b.practice.trials = y.needed("trials", "4").integer(1, 10000);
    bool const has_answer = !presented_orders(b.task, false).empty();
    b.practice.has_feedback = has_answer;
    if (y.has("feedback")) {
        b.practice.has_feedback = y.at("feedback").boolean();
        if (b.practice.has_feedback && !has_answer)
            throw y.at("feedback")
                .error(fmt::format("feedback on {}", facts(b.task).name), "no answer is right", "write false");
    }
    if (!y.has("level")) return;
    if (!b.compare || b.compare->factor >= 0)
        throw y.at("level").error("a level although nothing is varied", "it would be ignored", "remove it");
    b.practice.level = read_vary_level(y.at("level"), *b.compare);
}

/// Reads cross, nest, only.
void read_conditions(gi::Yaml const& y, Script const& s, Block& b)
{
    auto const is_crossed = [&](int f) { return std::find(b.cross.begin(), b.cross.end(), f) != b.cross.end(); };
    b.only.resize(s.factors.size());
    if (y.has("only"))
        for (auto const& [key, value] : y.at("only").entries()) {
            int const f = read_factor(key, s);
            for (gi::Yaml const& level : value.one_or_more())
                b.only[std::size_t(f)].push_back(read_level(level, s, f));
            if (b.only[std::size_t(f)].empty())
                throw value.error("no levels", "the block would be empty", "name one");
        }
    if (y.has("cross"))
        for (gi::Yaml const& name : y.at("cross").one_or_more()) {
            int const f = read_factor(name, s);
            if (is_crossed(f))
                throw name.error("'" + name.text() + "' is crossed twice", "once is enough", "remove one");
            b.cross.push_back(f);
        }
    if (!y.has("nest")) return;
    for (auto const& [key, value] : y.at("nest").entries()) {
        check_keys(value, "nest");
        Nest n;
        n.factor = read_factor(key, s);
        gi::Yaml const in = value.needed("in", "scene");
        n.within = read_factor(in, s);
        if (!is_crossed(n.within) || is_crossed(n.factor) || !b.only[std::size_t(n.factor)].empty())
            throw key.error(fmt::format("'{}' cannot be nested in '{}'", key.text(), in.text()),
                            "the outer factor must be crossed and the inner one neither crossed nor under 'only'",
                            fmt::format("write cross: [{}]", in.text()));
        n.levels.resize(s.factors[std::size_t(n.within)].levels.size());
        for (auto const& [outer, inner] : value.needed("levels", "{arches: [left, right]}").entries())
            for (gi::Yaml const& level : inner.one_or_more())
                n.levels[std::size_t(read_level(outer, s, n.within))].push_back(read_level(level, s, n.factor));
        for (int const outer : crossed_levels(s, b, n.within))
            if (n.levels[std::size_t(outer)].empty())
                throw value.error(fmt::format("'{}' has no levels within {}", key.text(),
                                              s.factors[std::size_t(n.within)].levels[std::size_t(outer)].name),
                                  "that part of the block would be empty", "name some");
        b.nest.push_back(n);
    }
}

void read_stimuli(gi::Yaml const& y, Script const& s, Block& b)
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
    if (y.has("pairs")) b.pairs = read_pairs(y.at("pairs"), s);
    if (y.has("compare")) b.compare = read_compare(y.at("compare"), s);
    if (b.task == Task::ranking) {
        gi::Yaml const rank = y.needed("rank", "{factor: FACTOR}");
        check_keys(rank, "rank");
        b.rank = read_factor(rank.needed("factor", "visibility"), s);
        b.rank_levels = read_levels_of(rank, s, b.rank, 2);
        if (b.rank_levels.size() > 9)
            throw rank.error(fmt::format("{} to rank", b.rank_levels.size()),
                             "the order is typed as digits 1 to 9", "omit some");
    }
    auto const has_reference = [&](int factor) {
        return std::any_of(s.reference.begin(), s.reference.end(),
                           [&](LevelChoice c) { return c.factor == factor; });
    };
    if (b.task == Task::pair_with_reference && !has_reference(b.pairs->factor))
        throw y.at("pairs").error(
            fmt::format("factor '{}' has no reference", s.factors[std::size_t(b.pairs->factor)].name),
            "the task shows it with the pair", "add it to reference");
    if (b.task == Task::rating) b.scale = read_scale(y.needed("scale", "{min: 1, max: 7}"));
    if (y.has("modulus")) b.magnitude.modulus = y.at("modulus").number(1e-6, 1e9);
    if (y.has("standard")) b.magnitude.standard = read_choice(y.at("standard"), s);
    if (y.has("modulus") != y.has("standard"))
        throw y.error("'modulus' and 'standard' belong together", "the modulus is the number of the standard",
                      "give both or none");
    if (b.task == Task::questionnaire)
        b.questionnaire = read_questionnaire_name(y.needed("questionnaire", "ssq"), s);
    if (y.has("duration_s")) b.duration_s = y.at("duration_s").number(1, 36000);

    bool const varies = b.compare && b.compare->factor < 0;
    if (y.has("procedure") && y.has("interleave"))
        throw y.at("procedure").error("both procedure and interleave", "interleave has them all", "keep one");
    if (varies != (y.has("procedure") || y.has("interleave")))
        throw y.error(varies ? fmt::format("no procedure varies '{}'", b.compare->vary)
                             : "a procedure without a setting to vary",
                      "a procedure chooses levels of the setting in compare",
                      varies ? "add procedure: {method: constant, levels: [...]}"
                             : "write compare: {vary: SETTING}");
    if (y.has("procedure")) b.procedures.push_back(read_procedure(y.at("procedure"), *b.compare, b.task));
    if (y.has("interleave"))
        for (gi::Yaml const& item : y.at("interleave").items()) {
            b.procedures.push_back(read_procedure(item, *b.compare, b.task));
            for (std::size_t i = 0; i + 1 < b.procedures.size(); ++i)
                if (b.procedures[i].name == b.procedures.back().name)
                    throw item.error("two procedures named '" + b.procedures[i].name + "'",
                                     "records could not distinguish them", "give each a name");
        }
    if (varies && b.procedures.empty())
        throw y.at("interleave").error("nothing to interleave", "the block would be empty", "name procedures");
}

} // namespace

Block read_block(gi::Yaml const& name, gi::Yaml const& y, Script const& s)
{
    Block b;
    b.name = name.name();
    b.place = name.place();
    gi::Yaml const task = y.needed("task", "rating");
    std::vector<std::string> names;
    for (Task const t : kTasks) names.emplace_back(facts(t).name);
    b.task = kTasks[std::size_t(task.one_of(names, "task"))];
    check_block_keys(y, b.task);
    b.is_sequential = facts(b.task).is_sequential;
    b.timing = s.defaults.timing;
    b.camera = s.defaults.camera;
    b.stimuli = s.defaults.stimuli;
    b.settings = s.defaults.settings;
    b.gaze = s.defaults.gaze;
    read_trial_timing(y, b.timing);
    read_conditions(y, s, b);
    read_stimuli(y, s, b);
    if (y.has("prompt")) b.prompt = y.at("prompt").text();
    if (y.has("instructions")) b.instructions = y.at("instructions").text();
    if (y.has("repeats")) b.repeats = y.at("repeats").integer(1, 10000);
    if (y.has("shuffle"))
        b.shuffle = Shuffle(y.at("shuffle").one_of({"all", "within_repeats", "none"}, "way to shuffle"));
    if (y.has("feedback")) b.has_feedback = y.at("feedback").boolean();
    if (y.has("ties")) b.may_tie = y.at("ties").boolean();
    if (y.has("presentation"))
        b.is_sequential = y.at("presentation").one_of({"simultaneous", "sequential"}, "presentation") == 1;
    bool const shows_several = facts(b.task).takes_pairs || b.task == Task::two_interval ||
                               b.task == Task::ranking || b.magnitude.modulus > 0;
    if (b.is_sequential && shows_several && !b.timing.stimulus_ms)
        throw y.error(fmt::format("block '{}' shows stimuli one after another, each until the answer", b.name),
                      "there is only one answer, after all of them", "add stimulus_ms: 2000");
    if (y.has("break_every")) b.break_every = y.at("break_every").integer(1, 100000);
    if (y.has("break_s")) b.break_s = y.at("break_s").number(0, 3600);
    if (y.has("camera")) b.camera = y.at("camera").text();
    if (y.has("stimuli")) b.stimuli = Stimuli(y.at("stimuli").one_of({"live", "prepared"}, "way to make stimuli"));
    if (y.has("settings"))
        for (auto const& [key, value] : read_patch(y.at("settings"))) set_setting(b.settings, key, value);
    if (y.has("gaze")) read_gaze(y.at("gaze"), b.gaze);
    if (y.has("catch")) b.catches = read_catch(y.at("catch"), b, s);
    if (y.has("practice")) read_practice(y.at("practice"), b);
    if (y.has("constraints"))
        for (gi::Yaml const& item : y.at("constraints").items()) b.constraints.push_back(read_constraint(item, s));
    return b;
}

} // namespace study
