#include "viewer/report/page.h"

#include "gi/core/html.h"
#include "viewer/report/html.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

std::string cell_html(Cell const& cell)
{
    if (std::holds_alternative<std::string>(cell)) return "<td>" + gi::escaped(to_text(cell)) + "</td>";
    auto const* m = std::get_if<Measured>(&cell);
    std::string spread;
    if (m != nullptr) {
        std::string const min = fmt::format("{:.3g}", m->min), max = fmt::format("{:.3g}", m->max);
        if (min != max) spread = " <small>" + min + "–" + max + "</small>";
    }
    return "<td class=\"number\">" + to_text(m != nullptr ? Cell(m->median) : cell) + spread + "</td>";
}

bool holds_text(BenchTable const& t, std::size_t column)
{
    return std::any_of(t.rows.begin(), t.rows.end(),
                       [&](auto const& row) { return std::holds_alternative<std::string>(row[column]); });
}

std::string rows_html(BenchTable const& t)
{
    std::string html = "<div class=\"wide\"><table>\n<thead><tr>";
    for (std::size_t c = 0; c < t.columns.size(); ++c)
        if (!names_file(t.columns[c]))
            html += fmt::format("<th scope=\"col\"{}>{}</th>", holds_text(t, c) ? "" : " class=\"number\"",
                                gi::escaped(readable(t.columns[c])));
    html += "</tr></thead>\n<tbody>\n";
    for (auto const& row : t.rows) {
        html += "<tr>";
        for (std::size_t c = 0; c < row.size(); ++c)
            if (!names_file(t.columns[c])) html += cell_html(row[c]);
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

bool has_spread(BenchTable const& t)
{
    auto const spreads = [](Cell const& cell) {
        auto const* m = std::get_if<Measured>(&cell);
        return m != nullptr && m->repeats > 1;
    };
    return std::any_of(t.rows.begin(), t.rows.end(),
                       [&](auto const& row) { return std::any_of(row.begin(), row.end(), spreads); });
}

std::string origin_html(BenchTable const& t)
{
    std::string html =
        "<details>\n<summary>how it was measured: " + gi::escaped(to_text(t.machine)) + "</summary>\n<dl>\n";
    auto const entry = [&](std::string const& what, std::string const& value) {
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", gi::escaped(what), gi::escaped(value));
    };
    entry("machine", to_text(t.machine));
    entry("program", t.program);
    entry("date", t.date);
    for (auto const& [what, value] : t.facts) entry(what, value);
    return html + "</dl>\n<p>To repeat it:</p>\n<pre><code>" + gi::escaped(t.command) +
           "</code></pre>\n</details>\n";
}

std::string section(BenchTable const& t, std::filesystem::path const& folder, PagePictures pictures)
{
    std::string html = fmt::format("<section>\n<h2>{}</h2>\n", gi::escaped(t.title.empty() ? t.name : t.title));
    std::string const figures = sweep_figures(t, folder) + picture_grids(t, folder, pictures);
    html +=
        origin_html(t) + figures + (figures.empty() ? "<h3>Rows</h3>\n" : "<details>\n<summary>rows</summary>\n");
    if (has_spread(t))
        html += "<p class=\"note\">Medians; below them the smallest and largest measured values.</p>\n";
    return html + rows_html(t) + (figures.empty() ? "" : "</details>\n") + "</section>\n";
}

} // namespace

std::string make_page(Page const& page)
{
    std::string const title = gi::escaped(page.title);
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
                       title + "</title>\n<style>\n";
    html += page_style();
    html += "</style>\n</head>\n<body>\n<header><h1>" + title + "</h1></header>\n<main>\n";
    if (!page.lead.empty()) html += "<p>" + gi::escaped(page.lead) + "</p>\n";
    for (BenchFolder const& folder : page.folders) html += render_figures(folder);
    for (BenchFolder const& folder : page.folders)
        for (BenchTable const& table : folder.tables) html += section(table, folder.path, page.pictures);
    if (!page.next.empty()) {
        html += "<section>\n<h2>Next</h2>\n";
        for (std::string const& command : page.next)
            html += "<pre><code>" + gi::escaped(command) + "</code></pre>\n";
        html += "</section>\n";
    }
    return html + "</main>\n</body>\n</html>\n";
}

} // namespace viewer
