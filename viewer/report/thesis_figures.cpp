#include "gi/core/html/html.h"
#include "viewer/report/chart.h"
#include "viewer/report/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>

namespace viewer {
namespace {

struct ThesisRow {
    BenchTable const* table;
    std::vector<Cell> const* cells;

    double value(char const* column) const { return number(cell(*table, *cells, column)); }
    std::string text(char const* column) const { return to_text(cell(*table, *cells, column)); }
};

/// What a table of the thesis varies: along the horizontal axis, and from curve to curve.
struct Varied {
    char const* table;
    char const* x_label;
    std::function<double(ThesisRow const&)> x;
    std::function<std::string(ThesisRow const&)> curve;
    std::function<double(ThesisRow const&)> order; ///< of curves; errors are comparable where it is the same
};

std::vector<Varied> varied()
{
    auto const column = [](char const* name) { return [name](ThesisRow const& r) { return r.value(name); }; };
    auto const of_model = [](ThesisRow const& r) {
        return fmt::format("{:.0f}K triangles", r.value("triangles") / 1000);
    };
    auto const bounces = [](ThesisRow const& r) {
        return fmt::format("{:g} bounce{}", r.value("bounces"), r.value("bounces") == 1 ? "" : "s");
    };
    auto const after_colon = [](ThesisRow const& r) {
        std::string const set = r.text("directions");
        return std::atof(set.substr(set.find(':') + 1).c_str());
    };
    auto const before_colon = [](ThesisRow const& r) {
        return r.text("directions").substr(0, r.text("directions").find(':'));
    };
    auto const none = [](ThesisRow const&) { return std::string(); };
    auto const same = [](ThesisRow const&) { return 0.0; };
    return {{"6.1", "triangles", column("triangles"), bounces, column("bounces")},
            {"6.2", "directions", after_colon, before_colon, same},
            {"6.3", "texels on a side of a hit buffer", column("hit_buffer"), of_model, column("triangles")},
            {"6.4", "paths per pixel", column("paths"), of_model, column("triangles")},
            {"6.5", "triangles", column("triangles"), none, same}};
}

struct Measure {
    char const* column;
    std::string name; ///< of its curves
};

/// A curve for each measure and each kind of curve; without points where nothing was measured.
std::vector<gi::PlotSeries> curves_of(std::vector<ThesisRow> const& rows, Varied const& v,
                                      std::function<double(ThesisRow const&)> const& x,
                                      std::vector<Measure> const& measures)
{
    std::vector<gi::PlotSeries> curves;
    for (Measure const& m : measures)
        for (ThesisRow const& r : rows) {
            double const value = r.value(m.column);
            if (!std::isfinite(value)) continue;
            std::string const kind = v.curve(r), label = kind.empty() ? m.name : m.name + ", " + kind;
            auto at = std::ranges::find(curves, label, &gi::PlotSeries::label);
            if (at == curves.end()) at = curves.insert(at, {label, {}});
            at->points.push_back({x(r), value});
        }
    return curves;
}

/// The exponent with which a curve grows: the slope of a line through its logarithms (least squares). NaN: fewer than
/// two different places.
double exponent(gi::PlotSeries const& curve)
{
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (gi::PlotPoint const& p : curve.points) {
        if (!(p.x > 0) || !(p.y > 0)) continue;
        double const x = std::log(p.x), y = std::log(p.y);
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    double const spread = n * sxx - sx * sx;
    return spread > 1e-9 ? (n * sxy - sx * sy) / spread : std::nan("");
}

std::string growth(std::vector<gi::PlotSeries> const& curves)
{
    std::string words;
    for (gi::PlotSeries const& c : curves)
        if (double const e = exponent(c); std::isfinite(e))
            words += fmt::format("{}{}: {:.2f}", words.empty() ? "" : "; ", c.label, e);
    return words.empty() ? "" : gi::html_note("Exponents of growth: " + gi::escaped(words) + ".");
}

std::string figure(std::string const& title, std::string const& x_label, std::string const& y_label,
                   std::vector<gi::PlotSeries> curves)
{
    Chart chart;
    chart.title = title;
    chart.x_label = x_label;
    chart.y_label = y_label;
    chart.curves = std::move(curves);
    return to_figure(chart);
}

std::string table_html(Varied const& v, std::vector<ThesisRow> const& rows)
{
    std::string const name = fmt::format("table {}", v.table);
    bool const of_rays = std::string_view(v.table) == "6.5";
    std::vector<gi::PlotSeries> const costs =
        of_rays ? curves_of(rows, v, v.x,
                            {{"rays_per_s", "slhb"},
                             {"published_rays_per_s", "published"},
                             {"embree_rays_per_s", "Embree"},
                             {"optix_rays_per_s", "published, OptiX"}})
                : curves_of(rows, v, v.x, {{"frame_ms", "slhb"}, {"published_ms", "published"}});
    std::string charts = figure(name + (of_rays ? ": rays per second" : ": time of a frame"), v.x_label,
                                of_rays ? "rays per second" : "ms", costs);
    std::vector<Measure> errors{{"l2_flip", "slhb"}};
    if (std::string_view(v.table) != "6.3")
        errors.push_back({"paths_l2_flip", "paths"}); // which have no hit buffers
    charts += figure(name + ": error of indirect light", v.x_label, "FLIP", curves_of(rows, v, v.x, errors));
    std::vector<ThesisRow> last;
    for (ThesisRow const& r : rows)
        if (v.order(r) == v.order(rows.back())) last.push_back(r);
    std::vector<gi::PlotSeries> by_time =
        curves_of(last, v, [](ThesisRow const& r) { return r.value("frame_ms"); }, {{"l2_flip", "slhb"}});
    Varied alike = v;
    alike.curve = [](ThesisRow const&) { return std::string(); };
    for (auto const& [ms, flip, tool] :
         {std::array{"paths_ms", "paths_l2_flip", "paths"}, {"embree_ms", "embree_l2_flip", "Embree"}})
        for (gi::PlotSeries& c :
             curves_of(last, alike, [&](ThesisRow const& r) { return r.value(ms); }, {{flip, tool}}))
            by_time.push_back(std::move(c));
    charts += figure(name + ": error against time", "time of a frame, ms", "FLIP of indirect light", by_time);
    return gi::html_part("Table " + std::string(v.table), gi::html_group("charts", charts) + growth(costs));
}

} // namespace

std::string thesis_figures(std::vector<BenchFolder> const& folders)
{
    std::string html;
    for (Varied const& v : varied()) {
        std::vector<ThesisRow> rows;
        for (BenchFolder const& folder : folders)
            for (BenchTable const& t : folder.tables)
                for (std::vector<Cell> const& row : t.rows)
                    if (ThesisRow const r{&t, &row}; t.name == "thesis" && r.text("table") == v.table)
                        rows.push_back(r);
        std::ranges::stable_sort(rows, {}, [&](ThesisRow const& r) { return std::pair(v.order(r), v.x(r)); });
        if (!rows.empty()) html += table_html(v, rows);
    }
    if (html.empty()) return "";
    return gi::html_section(
        "Tables of Yu 2012",
        gi::html_note("slhb: look-ups alone, all hit buffers built anew; paths and Embree (the method "
                      "reference): as many paths and bounces by exact rays; published: Yu 2012, on a "
                      "GeForce GTX 480.") +
            html);
}

} // namespace viewer
