#include "gi/core/text.h"
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

void read_staircase(gi::Yaml const& y, Compare const& c, Procedure& p)
{
    check_keys(y, "staircase");
    if (y.has("target")) {
        if (y.has("up") || y.has("down"))
            throw y.error("both target and up or down", "a weighted staircase is 1 up, 1 down, with unequal steps",
                          "keep one");
        p.target = y.at("target").number(0.5, 0.99);
    }
    if (y.has("up")) p.up = y.at("up").integer(1, 20);
    if (y.has("down")) p.down = y.at("down").integer(1, 20);
    p.start = y.needed("start", "256").number(-kAny, kAny);
    if (p.start < c.low || p.start > c.high)
        throw y.at("start").error(fmt::format("the staircase starts at {:g}", p.start),
                                  fmt::format("its range is {:g} to {:g}", c.low, c.high), "start within");
    for (gi::Yaml const& step : y.needed("steps", "[2, 1, 0.5]").one_or_more())
        p.steps.push_back(step.number(1e-9, kAny));
    if (p.steps.empty()) throw y.at("steps").error("no steps", "it could not move", "write [2, 1, 0.5]");
    p.stop = read_stop(y.needed("stop", "{reversals: 8, max_trials: 40}"), true);
}

void read_questplus(gi::Yaml const& y, Compare const& c, Procedure& p)
{
    check_keys(y, "questplus");
    p.threshold = read_grid(y.needed("threshold", "64..16384/33"), c.scale, c.low, c.high);
    p.slope = read_grid(y.needed("slope", "[1, 2, 3.5, 5]"), Scale::linear, 1e-6, kAny);
    p.guess = read_grid(y.needed("guess", "0.5"), Scale::linear, 0, 0.99);
    p.lapse = read_grid(y.needed("lapse", "[0, 0.02, 0.04]"), Scale::linear, 0, 0.5);
    p.stimuli = y.has("levels") ? read_grid(y.at("levels"), c.scale, c.low, c.high) : p.threshold;
    if (p.stimuli.size() < 2)
        throw y.error("questplus has only one level to present", "it could not choose",
                      "give 'levels' as 64..16384/33");
    double const size = double(p.threshold.size() * p.slope.size()) * double(p.guess.size() * p.lapse.size());
    if (size * double(p.stimuli.size()) > 2e7)
        throw y.error(fmt::format("{:g} points of the prior times {} levels", size, p.stimuli.size()),
                      "computing them would delay trials", "make the grids coarser");
    if (y.has("psychometric")) {
        std::vector<std::string> const known{"weibull", "normal", "logistic"};
        p.psychometric = Psychometric(y.at("psychometric").one_of(known, "psychometric function"));
    }
    p.stop = read_stop(y.needed("stop", "{trials: 32}"), false);
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

Procedure read_procedure(gi::Yaml const& y, Compare const& c, Task task)
{
    Procedure p;
    p.place = y.place();
    std::vector<std::string> const methods = task == Task::adjustment
                                                 ? std::vector<std::string>{"adjustment"}
                                                 : std::vector<std::string>{"constant", "staircase", "questplus"};
    std::string const method =
        methods[std::size_t(y.needed("method", methods[0]).one_of(methods, "method of this task"))];
    p.method = *method_of(method);
    p.name = y.has("name") ? y.at("name").name() : method;
    if (p.method == Method::staircase) {
        read_staircase(y, c, p);
    } else if (p.method == Method::questplus) {
        read_questplus(y, c, p);
    } else {
        bool const is_constant = p.method == Method::constant;
        check_keys(y, is_constant ? "constant" : "adjustment");
        char const* const key = is_constant ? "levels" : "starts";
        p.levels = read_grid(y.needed(key, "[64, 256, 1024]"), c.scale, c.low, c.high);
        if (y.has("trials_per_level")) p.trials_per_level = y.at("trials_per_level").integer(1, 1000);
    }
    return p;
}

} // namespace study
