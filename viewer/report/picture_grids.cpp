#include "gi/core/html/html.h"
#include "viewer/report/html.h"
#include "viewer/report/page.h"
#include "viewer/report/picture_summary.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

/// Pictures of one scene with one budget.
struct PictureGroup {
    std::string scene, budget;
    std::vector<std::vector<Cell> const*> rows;
    double worst = 0; ///< largest ratio of errors
};

std::vector<PictureGroup> picture_groups(BenchTable const& t)
{
    std::vector<PictureGroup> groups;
    for (auto const& row : t.rows) {
        if (to_text(cell(t, row, "picture_file")).empty()) continue; // a mean
        std::string const scene = to_text(cell(t, row, "scene")), budget = to_text(cell(t, row, "budget"));
        auto at = std::ranges::find_if(
            groups, [&](PictureGroup const& g) { return g.scene == scene && g.budget == budget; });
        if (at == groups.end()) at = groups.insert(at, PictureGroup{scene, budget, {}});
        at->rows.push_back(&row);
    }
    for (PictureContest const& c : contests(t, "reference"))
        for (PictureGroup& g : groups)
            if (g.scene == c.scene && g.budget == c.budget && c.worst() > g.worst) g.worst = c.worst();
    std::ranges::stable_sort(groups, std::greater(), &PictureGroup::worst);
    return groups;
}

class GridWriter {
public:
    GridWriter(BenchTable const& table, std::filesystem::path const& folder, PagePictures pictures)
        : t_(table), folder_(folder), pictures_(pictures)
    {
    }

    std::string group(PictureGroup const& g) const
    {
        std::string html;
        if (g.worst > 0)
            html = gi::html_note(fmt::format("largest error, relative to the method reference: {:.3g}", g.worst));
        std::vector<std::pair<std::string, std::string>> strips;
        for (auto const* row : g.rows) {
            std::string const heading = "filter " + text(*row, "filter");
            auto at = std::ranges::find(strips, heading, [](auto const& s) { return s.first; });
            if (at == strips.end()) at = strips.emplace(at, heading, "");
            at->second += figure(*row);
        }
        html +=
            picture_strips(picture(*g.rows.front(), "reference_file", g.scene + ", reference picture"), strips);
        return gi::html_part(g.scene + ", " + g.budget, html);
    }

private:
    std::string text(std::vector<Cell> const& row, char const* column) const
    {
        return to_text(cell(t_, row, column));
    }
    double value(std::vector<Cell> const& row, char const* column) const { return number(cell(t_, row, column)); }

    /// Accepts only names within the folder, as tables may be from an untrusted source.
    std::string picture(std::vector<Cell> const& row, char const* column, std::string const& description) const
    {
        std::filesystem::path const file = folder_ / std::filesystem::path(text(row, column)).filename();
        return (pictures_ == PagePictures::linked ? linked_png(file, description)
                                                  : embedded_png(file, description)) +
               "\n";
    }

    std::string figure(std::vector<Cell> const& row) const
    {
        std::string const what =
            fmt::format("{}, {}, {}", text(row, "scene"), text(row, "method"), text(row, "budget"));
        return gi::html_figure(
            picture(row, "picture_file", what) + picture(row, "flip_file", "FLIP error of " + what),
            fmt::format("<b>{}</b>, {:.3g} paths, {:.3g} s<br>relMSE {:.3g}, FLIP {:.3g}<br>correlation {:.2f}",
                        gi::escaped(text(row, "method")), value(row, "paths"), value(row, "total_s"),
                        value(row, "relmse"), value(row, "flip"), value(row, "neighbour_correlation")));
    }

    BenchTable const& t_;
    std::filesystem::path const& folder_;
    PagePictures pictures_;
};

} // namespace

std::string picture_grids(BenchTable const& table, std::filesystem::path const& folder, PagePictures pictures)
{
    for (char const* needed :
         {"scene", "budget", "method", "filter", "neighbour_correlation", "picture_file", "flip_file"})
        if (table.column(needed) < 0) return "";
    if (table.rows.empty()) return "";
    GridWriter const writer(table, folder, pictures);
    std::string html = picture_note();
    for (PictureGroup const& g : picture_groups(table)) html += writer.group(g);
    return html;
}

} // namespace viewer
