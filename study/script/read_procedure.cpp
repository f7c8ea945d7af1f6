#include "gi/core/text.h"
#include "study/script/procedure_settings.h"
#include "study/script/read.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

constexpr double kAny = 1e12;

/// Reads "a..b/n".
std::vector<double> parse_range(gi::Yaml const& y, Scale scale)
{
    std::string const s = y.text();
    auto const dots = s.find(".."), slash = s.find('/');
    auto const bad = [&](std::string const& why) {
        return y.error(fmt::format("'{}' is no grid", s.substr(0, 64)), why, "write 3, [1, 2, 4] or 64..16384/33");
    };
    if (dots == std::string::npos || slash == std::string::npos || slash < dots)
        throw bad("it is neither a number, a list nor from..to/count");
    auto const low = gi::parse_finite(std::string_view(s).substr(0, dots)),
               high = gi::parse_finite(std::string_view(s).substr(dots + 2, slash - dots - 2)),
               count = gi::parse_finite(std::string_view(s).substr(slash + 1));
    if (!low || !high || !count || !(*low < *high)) throw bad("from and to must be rising numbers");
    if (!(*count >= 2 && *count <= 1000) || *count != std::floor(*count)) throw bad("it needs 2 to 1000 points");
    if (scale != Scale::linear && *low <= 0) throw bad("a logarithmic scale begins above 0");
    std::vector<double> grid;
    int const n = int(*count);
    double const from = to_scale(scale, *low), to = to_scale(scale, *high);
    for (int i = 0; i < n; ++i) {
        double const share = double(i) / (n - 1);
        grid.push_back(from_scale(scale, from + share * (to - from)));
    }
    grid.front() = *low;
    grid.back() = *high;
    return grid;
}

/// Reads max_trials or trials.
Stop read_stop(gi::Yaml const& y, bool may_reverse, Mistakes& m)
{
    std::size_t const before = m.count();
    m.check_keys(y, "stop");
    Stop stop;
    if (y.has("trials") && y.has("max_trials"))
        m.add(y.error("both trials and max_trials", "they have the same meaning", "keep one"));
    for (char const* key : {"trials", "max_trials"})
        m.take(y, key, [&](gi::Yaml const& v) { stop.trials = int(v.integer(1, 10000)); });
    m.take(y, "reversals", [&](gi::Yaml const& v) {
        if (!may_reverse)
            throw v.error("questplus has no reversals", "it has no steps", "write stop: {trials: 32}");
        stop.reversals = int(v.integer(1, 1000));
    });
    if (stop.trials == 0 && m.count() == before)
        throw y.error("this procedure may never end", "reversals may not occur", "add max_trials");
    return stop;
}

/// The values that formulas of a procedure may use; the first ones, of the stimulus, must be used.
std::vector<std::string> formula_names(Procedure const& p)
{
    if (!p.is_many()) return {kPsychometricValues.begin(), kPsychometricValues.end()};
    std::vector<std::string> names{"x"};
    for (QuestGrid const& g : p.also) names.push_back(g.name);
    names.insert(names.end(), kPsychometricValues.begin() + 1, kPsychometricValues.end());
    for (QuestGrid const& g : p.parameters) names.push_back(g.name);
    return names;
}

/// A name, or a formula, which has more than letters.
void read_psychometric(gi::Yaml const& y, Procedure& p, Mistakes& m)
{
    m.take(y, "psychometric", [&](gi::Yaml const& v) {
        std::string const text = v.text();
        bool const is_word = std::all_of(text.begin(), text.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        });
        if (is_word) {
            if (p.is_many())
                throw v.error("'" + text + "' of several settings or further parameters", "it is of one setting",
                              "write a formula of x, their names and the parameters");
            p.psychometric = {Psychometric(v.one_of(psychometric_names(), "psychometric function")), {}};
            return;
        }
        try {
            std::size_t const needed = p.is_many() ? 1 + p.also.size() : 2;
            p.psychometric = {Psychometric::formula,
                              std::make_shared<Formula const>(text, formula_names(p), needed)};
        } catch (FormulaError const& e) {
            gi::TextLocation where = v.place();
            where.column += e.column - 1 + (v.is_quoted() ? 1 : 0);
            throw gi::InputError(where, e.problem, e.why, e.suggestion);
        }
    });
}

void read_staircase(gi::Yaml const& y, Compare const& c, Task task, Procedure& p, Mistakes& m)
{
    std::size_t const before = m.count();
    m.check_keys(y, "staircase");
    m.take(y, "target", [&](gi::Yaml const& v) { p.target = v.number(0.5, 0.99); });
    if (y.has("target") && (y.has("up") || y.has("down")))
        m.add(y.error("both target and up or down", "a weighted staircase is 1 up, 1 down, with unequal steps",
                      "keep one"));
    m.take(y, "up", [&](gi::Yaml const& v) { p.up = int(v.integer(1, 20)); });
    m.take(y, "down", [&](gi::Yaml const& v) { p.down = int(v.integer(1, 20)); });
    m.need(y, "start", "256", [&](gi::Yaml const& v) {
        p.start = v.number(-kAny, kAny);
        if (p.start < c.low || p.start > c.high)
            throw v.error(fmt::format("the staircase starts at {:g}", p.start),
                          fmt::format("its range is {:g} to {:g}", c.low, c.high), "start within");
    });
    m.need(y, "steps", "[2, 1, 0.5]", [&](gi::Yaml const& v) {
        for (gi::Yaml const& step : v.one_or_more()) p.steps.push_back(step.number(1e-9, kAny));
        if (p.steps.empty()) throw v.error("no steps", "it could not move", "write [2, 1, 0.5]");
    });
    read_psychometric(y, p, m);
    m.need(y, "stop", "{reversals: 8, max_trials: 40}",
           [&](gi::Yaml const& v) { p.stop = read_stop(v, true, m); });
    if (m.count() == before && settles_at(p) <= guess_rate(task) + 1e-9)
        m.add(y.error(fmt::format("the staircase converges to {:.2f} % correct", 100 * settles_at(p)),
                      fmt::format("guessing gives {:.2f} % in {}, so its level would only wander",
                                  100 * guess_rate(task), facts(task).name),
                      "write down: 2 (70.71 %), or target: 0.75"));
}

/// The proportions that QUEST+ would use.
void check_function(gi::Yaml const& y, Compare const& c, Procedure const& p, Mistakes& m)
{
    PsychometricChoice const function = assumed_function(p);
    double const lowest = std::min(p.stimuli.front(), p.threshold.front());
    if (function.function == Psychometric::weibull && lowest <= 0)
        m.add(y.error(fmt::format("Weibull's function of the level {:g}", lowest),
                      "it takes ratios of levels above 0", "write psychometric: gumbel or normal"));
    if (function.function != Psychometric::formula) return;
    for (double const level : p.stimuli)
        for (double const threshold : p.threshold)
            for (double const slope : p.slope)
                for (double const guess : {p.guess.front(), p.guess.back()}) {
                    double const share = proportion_correct(function, c.scale, c.harder_up,
                                                            {threshold, slope, guess, p.lapse.front()}, level);
                    if (share >= 0 && share <= 1) continue;
                    m.add(y.at("psychometric")
                              .error(
                                  fmt::format("the formula gives {:g} at x = {:g}, threshold = {:g}, slope = {:g}",
                                              share, level, threshold, slope),
                                  "a proportion lies between 0 and 1", "correct the formula or the grids"));
                    return;
                }
}

/// Its ends and, as near as possible, `count` values in all.
std::vector<double> some_of(std::vector<double> const& grid, std::size_t count)
{
    if (grid.size() <= count) return grid;
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(grid[i * (grid.size() - 1) / (count - 1)]);
    return out;
}

std::vector<double> even_grid(Compare const& c, int count)
{
    std::vector<double> grid;
    double const low = to_scale(c.scale, c.low), high = to_scale(c.scale, c.high);
    for (int i = 0; i < count; ++i) grid.push_back(from_scale(c.scale, low + (high - low) * i / (count - 1)));
    return grid;
}

/// The values that a formula may take besides x, in the order of its names: some of the grids, or, without them,
/// thresholds within the range and slopes of any size, as a slope is whatever it is in the formula.
std::vector<std::vector<double>> formula_grids(Procedure const& p, Compare const& c, Task task)
{
    std::vector<std::vector<double>> grids;
    for (QuestGrid const& g : p.also) grids.push_back(some_of(g.values, 3));
    if (p.method == Method::questplus) {
        grids.push_back(some_of(p.threshold, 9));
        for (std::vector<double> const* const grid : {&p.slope, &p.guess, &p.lapse})
            grids.push_back(some_of(*grid, 3));
    } else {
        grids.push_back(even_grid(c, 9));
        grids.push_back({1e-3, 1e-2, 0.1, 0.3, 1, 3, 10, 100, 1000});
        grids.push_back({guess_rate(task)});
        grids.push_back({0});
    }
    for (QuestGrid const& g : p.parameters) grids.push_back(some_of(g.values, 3));
    return grids;
}

/// What a formula does over the range of levels, whatever the other values are.
struct FormulaCourse {
    double lowest = 1, highest = 0;
    bool rises = false, falls = false;
};

FormulaCourse course_of(Formula const& formula, std::vector<double> const& levels,
                        std::vector<std::vector<double>> const& grids)
{
    constexpr double kFlat = 1e-9;
    FormulaCourse course;
    std::vector<std::size_t> digits(grids.size());
    std::vector<double> values(1 + grids.size());
    for (std::size_t digit = 0; digit < grids.size();) {
        for (std::size_t g = 0; g < grids.size(); ++g) values[1 + g] = grids[g][digits[g]];
        double before = std::nan("");
        for (double const level : levels) {
            values[0] = level;
            double const share = formula(values);
            course.rises |= share > before + kFlat;
            course.falls |= share < before - kFlat;
            if (std::isfinite(share)) {
                course.lowest = std::min(course.lowest, share);
                course.highest = std::max(course.highest, share);
            }
            before = share;
        }
        for (digit = 0; digit < grids.size() && ++digits[digit] == grids[digit].size(); ++digit) digits[digit] = 0;
    }
    return course;
}

/// Whether a formula goes the way that `harder` says and reaches the proportion that the threshold is at.
void check_formula(gi::Yaml const& y, Compare const& c, Task task, Procedure const& p, Mistakes& m)
{
    gi::Yaml const at = y.at("psychometric");
    Formula const& formula = *p.psychometric->formula;
    for (std::size_t i = 0; i < formula.names().size(); ++i)
        for (QuestGrid const& g : p.parameters)
            if (g.name == formula.names()[i] && !formula.uses(i))
                m.add(at.error(fmt::format("the formula does not use the parameter '{}'", g.name),
                               "no answer would tell its values apart", "use it, or remove it from parameters"));
    FormulaCourse const course = course_of(formula, even_grid(c, 33), formula_grids(p, c, task));
    if (c.harder_up ? course.rises && !course.falls : course.falls && !course.rises) {
        m.add(at.error(
            fmt::format("the formula {} with x", course.rises ? "rises" : "falls"),
            fmt::format("P(correct) must {} where {} levels are harder", c.harder_up ? "fall" : "rise",
                        c.harder_up ? "higher" : "lower"),
            fmt::format("write {}, or harder: {}",
                        c.harder_up ? "(threshold - x) or threshold / x" : "(x - threshold) or x / threshold",
                        c.harder_up ? "down" : "up")));
        return;
    }
    double const wanted = p.method == Method::staircase ? settles_at(p) : (1 + guess_rate(task)) / 2;
    if (course.lowest > wanted || course.highest < wanted)
        m.add(at.error(
            fmt::format("the formula gives {:g} to {:g} over the range of levels", course.lowest, course.highest),
            fmt::format("the threshold is where it gives {:g}, which it never does", wanted),
            "correct the formula, the grids or the range"));
}

void check_grids(gi::Yaml const& y, Compare const& c, Procedure const& p, Mistakes& m)
{
    if (p.is_many()) {
        m.attempt([&] {
            try {
                QuestPlusMany const unused(quest_many_settings(p));
            } catch (std::invalid_argument const& e) {
                throw y.error(e.what(), "", "");
            }
        });
        return;
    }
    if (p.stimuli.size() < 2)
        m.add(y.error("questplus has only one level to present", "it could not choose",
                      "give 'levels' as 64..16384/33"));
    double const size = double(p.threshold.size() * p.slope.size()) * double(p.guess.size() * p.lapse.size());
    if (size * double(p.stimuli.size()) > 2e7)
        m.add(y.error(fmt::format("{:g} points of the prior times {} levels", size, p.stimuli.size()),
                      "computing them would delay trials", "make the grids coarser"));
    else
        check_function(y, c, p, m);
}

/// Levels of further settings and values of further parameters.
void read_further_grids(gi::Yaml const& y, Compare const& c, Procedure& p, Mistakes& m)
{
    std::vector<std::string> further;
    for (FurtherSetting const& f : c.also) further.push_back(f.name);
    if (y.has("also"))
        for (auto const& [key, unused] : m.entries(y.at("also")))
            m.attempt([&, k = key] { k.one_of(further, "setting of compare.also"); });
    for (FurtherSetting const& f : c.also) // in the order of compare
        if (y.has("also") && y.at("also").has(f.name))
            m.attempt([&] {
                p.also.push_back({f.name, read_grid(y.at("also").at(f.name), f.scale, f.low, f.high)});
            });
        else
            m.add(y.error(fmt::format("no levels of '{}', which compare.also varies", f.name),
                          "it could not choose", fmt::format("write also: {{{}: [...]}}", f.name)));
    std::vector<std::string> taken{"x", "threshold", "slope", "guess", "lapse"};
    taken.insert(taken.end(), further.begin(), further.end());
    if (!y.has("parameters")) return;
    for (auto const& [key, value] : m.entries(y.at("parameters")))
        m.attempt([&, k = key, v = value] {
            std::string const name = k.name();
            if (std::find(taken.begin(), taken.end(), name) != taken.end())
                throw k.error("a parameter named '" + name + "'", "the formula has that name already",
                              "rename it");
            p.parameters.push_back({name, read_grid(v, Scale::linear, -kAny, kAny)});
        });
}

void read_questplus(gi::Yaml const& y, Compare const& c, Procedure& p, Mistakes& m)
{
    m.check_keys(y, "questplus");
    std::size_t const before = m.count();
    bool has_all = m.need(y, "threshold", "64..16384/33",
                          [&](gi::Yaml const& v) { p.threshold = read_grid(v, c.scale, c.low, c.high); });
    has_all &= m.need(y, "slope", "[1, 2, 3.5, 5]",
                      [&](gi::Yaml const& v) { p.slope = read_grid(v, Scale::linear, 1e-6, kAny); });
    has_all &=
        m.need(y, "guess", "0.5", [&](gi::Yaml const& v) { p.guess = read_grid(v, Scale::linear, 0, 0.99); });
    has_all &= m.need(y, "lapse", "[0, 0.02, 0.05]",
                      [&](gi::Yaml const& v) { p.lapse = read_grid(v, Scale::linear, 0, 0.5); });
    p.stimuli = p.threshold;
    m.take(y, "levels", [&](gi::Yaml const& v) { p.stimuli = read_grid(v, c.scale, c.low, c.high); });
    read_further_grids(y, c, p, m);
    read_psychometric(y, p, m);
    if (p.is_many() && !p.psychometric && m.count() == before)
        m.add(y.error("several settings or further parameters without a formula", "the function is unknown",
                      "write psychometric: FORMULA"));
    if (has_all && m.count() == before) check_grids(y, c, p, m);
    if (!p.guess.empty() && !p.lapse.empty() && p.guess.back() + p.lapse.back() >= 1)
        m.add(y.at("guess").error(fmt::format("guess {:g} with lapse {:g}", p.guess.back(), p.lapse.back()),
                                  "together they reach 1, which leaves no room for a curve",
                                  "use rates whose sum is below 1"));
    m.need(y, "stop", "{trials: 32}", [&](gi::Yaml const& v) { p.stop = read_stop(v, false, m); });
}

} // namespace

std::vector<double> read_grid(gi::Yaml const& y, Scale scale, double low, double high)
{
    std::vector<double> grid;
    if (y.is_list())
        for (gi::Yaml const& item : y.items()) grid.push_back(item.number(-kAny, kAny));
    else if (y.is_text() && gi::parse_finite(y.text()))
        grid.push_back(*gi::parse_finite(y.text()));
    else
        grid = parse_range(y, scale);
    if (grid.empty() || grid.size() > 1000)
        throw y.error(y.path() + " has no points, or more than 1000", "1 to 1000 are allowed", "change it");
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (grid[i] < low || grid[i] > high)
            throw y.error(fmt::format("{} has {:g}", y.path(), grid[i]),
                          fmt::format("it must lie between {:g} and {:g}", low, high), "change it");
        if (i > 0 && grid[i] <= grid[i - 1])
            throw y.error(fmt::format("{} has {:g} after {:g}", y.path(), grid[i], grid[i - 1]), "grids rise",
                          "sort it and remove duplicates");
    }
    return grid;
}

Procedure read_procedure(gi::Yaml const& y, Compare const& c, Task task, Mistakes& m)
{
    Procedure p;
    p.place = y.place();
    std::size_t const before = m.count();
    std::vector<std::string> const methods = task == Task::adjustment
                                                 ? std::vector<std::string>{"adjustment"}
                                                 : std::vector<std::string>{"constant", "staircase", "questplus"};
    std::string const method =
        methods[std::size_t(y.needed("method", methods[0].c_str()).one_of(methods, "method of this task"))];
    p.method = *method_of(method);
    p.name = method;
    m.take(y, "name", [&](gi::Yaml const& v) { p.name = v.name(); });
    if (p.method == Method::staircase) {
        read_staircase(y, c, task, p, m);
    } else if (p.method == Method::questplus) {
        read_questplus(y, c, p, m);
    } else {
        bool const is_constant = p.method == Method::constant;
        if (is_constant) read_psychometric(y, p, m);
        m.check_keys(y, is_constant ? "constant" : "adjustment");
        m.need(y, is_constant ? "levels" : "starts", "[64, 256, 1024]",
               [&](gi::Yaml const& v) { p.levels = read_grid(v, c.scale, c.low, c.high); });
        m.take(y, "trials_per_level", [&](gi::Yaml const& v) { p.trials_per_level = int(v.integer(1, 1000)); });
    }
    if (m.count() == before && p.psychometric && p.psychometric->formula) check_formula(y, c, task, p, m);
    return p;
}

} // namespace study
