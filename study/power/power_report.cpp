#include "study/power/power_study.h"

#include "gi/core/html/html.h"
#include "gi/core/html/plot.h"
#include "gi/core/text.h"
#include "study/analysis/shown.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace study {
namespace {

std::string summary_of(PowerStudy const& p, PowerSettings const& s)
{
    int const done = p.points.empty() ? 0 : p.points.front().simulations;
    return fmt::format("{}: test '{}' at p < {:g}, {} of {} simulations{}", p.block, p.test, s.alpha, done,
                       p.simulations_planned, p.is_complete ? "" : " (stopped)");
}

std::vector<std::string> row_of(PowerPoint const& p)
{
    return {cell(p.repeats),      cell(p.participants),  cell(p.effect),    cell(p.power),
            cell(p.interval.low), cell(p.interval.high), cell(p.found),     cell(p.simulations),
            cell(p.refused),      cell(p.estimate),      cell(p.deviation), cell(p.truth),
            cell(p.coverage)};
}

gi::PlotSeries curve_of(PowerStudy const& study, int repeats, double effect)
{
    gi::PlotSeries series{fmt::format("effect x {:g}", effect), {}};
    for (PowerPoint const& p : study.points)
        if (p.repeats == repeats && p.effect == effect && std::isfinite(p.power))
            series.points.push_back({double(p.participants), p.power, p.interval.low, p.interval.high});
    return series;
}

} // namespace

Table power_table(PowerStudy const& study, PowerSettings const& settings)
{
    Table t{{{"repeats", "Repeats of the block"},
             {"participants", "Participants"},
             {"effect", "Factor on the effects of the observers' model"},
             estimate_column("power", fmt::format("Share of simulations with p < {:g}", settings.alpha)),
             {"low", "Lower end of its 95 % interval (Wilson)"},
             {"high", "Upper end"},
             {"found", "Simulations with that p"},
             {"simulations", "Simulations"},
             {"refused", "Simulations whose data allowed no test: not found"},
             {"estimate", "Mean of the estimates", study.unit},
             {"sd", "Their standard deviation", study.unit},
             {"truth", "Estimate of a very large simulated experiment (with --recovery)", study.unit},
             {"coverage", "Share of intervals that contain it"}}};
    for (PowerPoint const& p : study.points) t.rows.push_back(row_of(p));
    return t;
}

std::string power_json(PowerStudy const& study, PowerSettings const& settings)
{
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    Table const t = power_table(study, settings);
    for (auto const& row : t.rows) {
        nlohmann::ordered_json object;
        for (std::size_t c = 0; c < row.size(); ++c) {
            auto const number = gi::parse_finite(row[c]);
            object[t.columns[c].name] = number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
        }
        rows.push_back(std::move(object));
    }
    nlohmann::ordered_json const j{
        {"block", study.block},          {"test", study.test},    {"unit", study.unit},
        {"alpha", settings.alpha},       {"seed", settings.seed}, {"simulations", study.simulations_planned},
        {"complete", study.is_complete}, {"points", rows}};
    return j.dump(2) + "\n";
}

std::string power_text(PowerStudy const& study, PowerSettings const& settings)
{
    Table const t = power_table(study, settings);
    ShownTable const shown = shown_table(t);
    std::vector<std::vector<std::string>> rows(1 + t.rows.size(), std::vector<std::string>{});
    for (std::size_t c = 0; c < shown.columns.size(); ++c) {
        bool const is_empty =
            std::all_of(shown.rows.begin(), shown.rows.end(), [&](auto const& r) { return r[c] == "–"; });
        if (is_empty) continue;
        rows[0].push_back(shown.columns[c].name);
        for (std::size_t k = 0; k < shown.rows.size(); ++k) rows[k + 1].push_back(shown.rows[k][c]);
    }
    return summary_of(study, settings) + "\n" + gi::aligned(rows, std::vector<bool>(rows[0].size(), true));
}

std::string power_page(Script const& script, PowerStudy const& study, PowerSettings const& settings,
                       std::string const& program)
{
    std::set<int> repeats, sizes;
    std::set<double> effects;
    for (PowerPoint const& p : study.points) {
        repeats.insert(p.repeats);
        effects.insert(p.effect);
        sizes.insert(p.participants);
    }
    std::string figures;
    for (int const r : repeats) {
        std::vector<double> const ends{double(*sizes.begin()), double(*sizes.rbegin())};
        std::vector<gi::PlotSeries> all;
        for (double const e : effects) all.push_back(curve_of(study, r, e));
        double const above = gi::legend_height(all, 640 - 56);
        gi::Plot plot(640, 316 + above, gi::axis_over(ends), gi::PlotAxis{0, 1});
        plot.margins(56, above, 110, 46);
        plot.x_axis("participants");
        plot.y_axis("power");
        plot.series(all);
        figures += plot.figure(fmt::format("Power with {} repeats", r),
                               gi::escaped(fmt::format("{} repeats of the block. Bars: 95 % intervals of the "
                                                       "simulations (Wilson).",
                                                       r)));
    }
    std::vector<gi::HtmlColumn> columns;
    ShownTable const t = shown_table(power_table(study, settings));
    for (ShownTable::Head const& head : t.columns) columns.push_back({head.name, true, head.description});
    std::vector<std::vector<gi::HtmlCell>> rows;
    for (auto const& row : t.rows) rows.emplace_back(row.begin(), row.end());
    return gi::html_page(fmt::format("{}: power", script.title.empty() ? script.id : script.title),
                         gi::html_section("Power", figures) +
                             gi::html_section("Table", gi::html_table(columns, rows)),
                         gi::html_note(gi::escaped(summary_of(study, settings) + ". " + program)));
}

} // namespace study
