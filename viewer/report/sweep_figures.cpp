#include "gi/core/html/html.h"
#include "viewer/report/chart.h"
#include "viewer/report/html.h"
#include "viewer/report/page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

using Row = std::vector<Cell>;

/// Rows of a table with the same value, in order.
struct Group {
    std::string value;
    std::vector<Row const*> rows;
};

std::vector<Group> group_by(BenchTable const& t, std::vector<Row const*> const& rows, std::string const& column)
{
    std::vector<Group> groups;
    for (Row const* row : rows) {
        std::string const value = to_text(cell(t, *row, column));
        auto at = std::find_if(groups.begin(), groups.end(), [&](Group const& g) { return g.value == value; });
        if (at == groups.end()) at = groups.insert(at, Group{value, {}});
        at->rows.push_back(row);
    }
    return groups;
}

std::string seconds_text(double s)
{
    return s < 1 ? fmt::format("{:.3g} ms", 1000 * s) : fmt::format("{:.3g} s", s);
}

std::string chart_html(BenchTable const& t, Group const& scene, std::string const& metric,
                       std::string const& label)
{
    if (t.column(metric) < 0) return "";
    Chart chart;
    chart.title = fmt::format("{}: {} over time", scene.value, label);
    chart.x_label = "time of a whole frame, s";
    chart.y_label = label;
    for (Group const& method : group_by(t, scene.rows, "method")) {
        gi::PlotSeries curve{method.value, {}};
        for (Row const* row : method.rows) {
            Cell const& error = cell(t, *row, metric);
            auto const* m = std::get_if<Measured>(&error);
            curve.points.push_back({number(cell(t, *row, "frame_s")), number(error), m != nullptr ? m->min : 0,
                                    m != nullptr ? m->max : 0});
        }
        chart.curves.push_back(std::move(curve));
    }
    double const noise = number(cell(t, *scene.rows.front(), "reference_" + metric));
    if (noise > 0) {
        chart.level = noise;
        chart.level_label = "noise of the reference";
    }
    return to_figure(chart);
}

/// Accepts only names within the folder, as tables may be from an untrusted source.
std::string picture_html(BenchTable const& t, Row const& row, std::string const& column,
                         std::filesystem::path const& folder, std::string const& description)
{
    auto const* name = std::get_if<std::string>(&cell(t, row, column));
    if (name == nullptr) return "";
    return embedded_png(folder / std::filesystem::path(*name).filename(), description) + "\n";
}

std::string picture_figure(BenchTable const& t, Row const& row, std::filesystem::path const& folder,
                           std::string const& what)
{
    std::string const budget = seconds_text(number(cell(t, row, "budget_s")));
    std::string words = fmt::format("<b>{}</b>, took {}<br>relMSE {:.3g}", budget,
                                    seconds_text(number(cell(t, row, "frame_s"))), number(cell(t, row, "relmse")));
    if (t.column("flip") >= 0) words += fmt::format(", FLIP {:.3g}", number(cell(t, row, "flip")));
    return gi::html_figure(picture_html(t, row, "picture_file", folder, what + ", " + budget) +
                               picture_html(t, row, "flip_file", folder, "FLIP error of " + what + ", " + budget),
                           words);
}

std::string pictures_html(BenchTable const& t, Group const& scene, std::filesystem::path const& folder)
{
    if (t.column("picture_file") < 0) return "";
    std::vector<std::pair<std::string, std::string>> strips;
    for (Group const& method : group_by(t, scene.rows, "method")) {
        strips.emplace_back(method.value, "");
        for (Row const* row : method.rows)
            strips.back().second += picture_figure(t, *row, folder, scene.value + ", " + method.value);
    }
    return picture_strips(
               picture_html(t, *scene.rows.front(), "reference_file", folder, scene.value + ", reference"),
               strips) +
           picture_note();
}

} // namespace

std::string picture_strips(std::string const& reference_html,
                           std::vector<std::pair<std::string, std::string>> const& strips)
{
    std::string html = "<div class=\"pictures\">\n<div>\n<h4>reference picture</h4>\n<figure>\n" + reference_html +
                       "</figure>\n</div>\n<div>\n";
    for (auto const& [heading, figures] : strips)
        html += "<h4>" + gi::escaped(heading) + "</h4>\n" + gi::html_group("strip", figures);
    return html + "</div>\n</div>\n";
}

std::string picture_note()
{
    return gi::html_note("Below each picture its FLIP error: 0 <span class=\"scale\"></span> 1. "
                         "Click a picture to see it at full size.");
}

std::string sweep_figures(BenchTable const& table, std::filesystem::path const& folder)
{
    for (char const* needed : {"scene", "method", "budget_s", "frame_s", "relmse"})
        if (table.column(needed) < 0) return "";
    std::vector<Row const*> all;
    for (Row const& row : table.rows) all.push_back(&row);
    std::string html;
    for (Group const& scene : group_by(table, all, "scene"))
        html += gi::html_part(scene.value, gi::html_group("charts", chart_html(table, scene, "relmse", "relMSE") +
                                                                        chart_html(table, scene, "flip", "FLIP")) +
                                               pictures_html(table, scene, folder));
    return html;
}

} // namespace viewer
