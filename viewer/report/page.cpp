#include "viewer/report/page.h"

#include "gi/core/html/html.h"
#include "viewer/report/html.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

gi::HtmlCell cell_html(Cell const& cell)
{
    auto const* m = std::get_if<Measured>(&cell);
    if (m == nullptr) return to_text(cell);
    std::string const min = fmt::format("{:.3g}", m->min), max = fmt::format("{:.3g}", m->max);
    std::string const spread = min != max ? " <small>" + min + "–" + max + "</small>" : "";
    return gi::HtmlCell::of(to_text(Cell(m->median)) + spread);
}

std::string rows_html(BenchTable const& t)
{
    std::vector<gi::HtmlColumn> columns;
    std::vector<std::vector<gi::HtmlCell>> rows(t.rows.size());
    for (std::size_t c = 0; c < t.columns.size(); ++c) {
        if (names_file(t.columns[c])) continue;
        columns.push_back({readable(t.columns[c]), !holds_text(t, c), ""});
        for (std::size_t r = 0; r < rows.size(); ++r) rows[r].push_back(cell_html(t.rows[r][c]));
    }
    return gi::html_table(columns, rows);
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
    std::vector<std::pair<std::string, std::string>> entries{
        {"machine", to_text(t.machine)}, {"program", t.program}, {"date", t.date}};
    entries.insert(entries.end(), t.facts.begin(), t.facts.end());
    return gi::html_details("how it was measured: " + to_text(t.machine), gi::html_definitions(entries) +
                                                                              gi::html_paragraph("To repeat it:") +
                                                                              gi::html_code(t.command));
}

std::string section(BenchTable const& t, std::filesystem::path const& folder, PagePictures pictures)
{
    std::string const figures = sweep_figures(t, folder) + picture_grids(t, folder, pictures);
    std::string rows = rows_html(t);
    if (has_spread(t))
        rows = gi::html_note("Medians; below them the smallest and largest measured values.") + rows;
    return gi::html_section(t.title.empty() ? t.name : t.title,
                            origin_html(t) + figures +
                                (figures.empty() && t.name != "thesis" ? gi::html_part("Rows", rows)
                                                                       : gi::html_details("rows", rows)));
}

} // namespace

std::string make_page(Page const& page)
{
    std::string html, next;
    if (!page.lead.empty()) html += gi::html_paragraph(page.lead);
    for (BenchFolder const& folder : page.folders) html += render_figures(folder);
    html += thesis_figures(page.folders);
    for (BenchFolder const& folder : page.folders)
        for (BenchTable const& table : folder.tables) html += section(table, folder.path, page.pictures);
    for (std::string const& command : page.next) next += gi::html_code(command);
    return gi::html_page(page.title, html + (next.empty() ? "" : gi::html_section("Next", next)));
}

} // namespace viewer
