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
Stop read_stop(gi::Yaml const& y, bool may_reverse)
{
    check_keys(y, "stop");
    Stop stop;
    if (y.has("trials") && y.has("max_trials"))
        throw y.error("both trials and max_trials", "they have the same meaning", "keep one");
    for (char const* key : {"trials", "max_trials"})
        if (y.has(key)) stop.trials = y.at(key).integer(1, 10000);
    if (y.has("reversals")) {
        if (!may_reverse)
            throw y.at("reversals")
                .error("questplus has no reversals", "it has no steps", "write stop: {trials: 32}");
        stop.reversals = y.at("reversals").integer(1, 1000);
    }
    if (stop.trials == 0)
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

void read_staircase(gi::Yaml const& y, Compare const& c, Procedure& p, Mistakes& m)
{
    m.check_keys(y, "staircase");
    m.take(y, "target", [&](gi::Yaml const& v) {
        if (y.has("up") || y.has("down"))
            throw y.error("both target and up or down", "a weighted staircase is 1 up, 1 down, with unequal steps",
                          "keep one");
        p.target = v.number(0.5, 0.99);
    });
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
    m.need(y, "stop", "{reversals: 8, max_trials: 40}", [&](gi::Yaml const& v) { p.stop = read_stop(v, true); });
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
    m.need(y, "stop", "{trials: 32}", [&](gi::Yaml const& v) { p.stop = read_stop(v, false); });
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
    std::vector<std::string> const methods = task == Task::adjustment
                                                 ? std::vector<std::string>{"adjustment"}
                                                 : std::vector<std::string>{"constant", "staircase", "questplus"};
    std::string const method =
        methods[std::size_t(y.needed("method", methods[0].c_str()).one_of(methods, "method of this task"))];
    p.method = *method_of(method);
    p.name = method;
    m.take(y, "name", [&](gi::Yaml const& v) { p.name = v.name(); });
    if (p.method == Method::staircase) {
        read_staircase(y, c, p, m);
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
    return p;
}

} // namespace study
