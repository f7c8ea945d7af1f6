#include "viewer/report/picture_summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

struct PictureRow {
    std::string scene, budget, method, filter;
    double total_s, relmse, flip;
};

std::vector<PictureRow> read_rows(BenchTable const& t)
{
    std::vector<PictureRow> rows;
    for (auto const& row : t.rows) {
        auto const text = [&](char const* column) { return to_text(cell(t, row, column)); };
        auto const value = [&](char const* column) { return number(cell(t, row, column)); };
        rows.push_back({text("scene"), text("budget"), text("method"), text("filter"), value("total_s"),
                        value("relmse"), value("flip")});
    }
    return rows;
}

std::vector<ErrorAtTime> curve_of(std::vector<PictureRow> const& rows, PictureRow const& like,
                                  std::string const& peer, double PictureRow::*error)
{
    std::vector<ErrorAtTime> curve;
    for (PictureRow const& r : rows)
        if (r.method == peer && r.scene == like.scene && r.filter == like.filter)
            curve.push_back({r.total_s, r.*error});
    return curve;
}

double share(double a, double b) { return b > 0 ? a / b : std::nan(""); }

/// Order by value, NaN last.
bool is_worse(PictureContest const& a, PictureContest const& b)
{
    double const x = a.worst(), y = b.worst();
    return std::isnan(y) ? !std::isnan(x) : x > y;
}

} // namespace

double PictureContest::worst() const
{
    return std::fmax(relmse_ratio, flip_ratio); // ignores NaN
}

std::vector<PictureContest> contests(BenchTable const& pictures, std::string const& peer)
{
    std::vector<PictureRow> const rows = read_rows(pictures);
    std::vector<PictureContest> found;
    for (PictureRow const& r : rows) {
        if (r.method == peer) continue;
        auto const p = std::ranges::find_if(rows, [&](PictureRow const& o) {
            return o.method == peer && o.scene == r.scene && o.budget == r.budget && o.filter == r.filter;
        });
        if (p == rows.end()) continue;
        PictureContest c{
            r.scene, r.budget, r.filter, r.method, share(r.relmse, p->relmse), share(r.flip, p->flip)};
        TimeAtError const relmse = time_at_error(curve_of(rows, r, peer, &PictureRow::relmse), r.relmse),
                          flip = time_at_error(curve_of(rows, r, peer, &PictureRow::flip), r.flip);
        c.time_ratio = share(r.total_s, p->total_s);
        c.relmse_time_factor = share(relmse.seconds, r.total_s);
        c.relmse_reached = relmse.reached;
        c.flip_time_factor = share(flip.seconds, r.total_s);
        c.flip_reached = flip.reached;
        found.push_back(std::move(c));
    }
    std::ranges::stable_sort(found, is_worse);
    return found;
}

std::vector<LostRows> lost_rows(std::vector<PictureContest> const& contests)
{
    std::vector<LostRows> lost;
    for (PictureContest const& c : contests) {
        auto at = std::ranges::find(lost, c.method, &LostRows::method);
        if (at == lost.end()) at = lost.insert(at, LostRows{c.method});
        ++at->rows;
        at->relmse += c.relmse_ratio > kLostRatio;
        at->flip += c.flip_ratio > kLostRatio;
        at->either += c.lost();
    }
    return lost;
}

std::vector<std::string> picture_summary_columns(std::string const& peer)
{
    return {"scene",
            "budget",
            "filter",
            "method",
            "relmse_over_" + peer,
            "flip_over_" + peer,
            "time_over_" + peer,
            "lost",
            "time_factor_at_relmse",
            "relmse_reached",
            "time_factor_at_flip",
            "flip_reached"};
}

void add_lost_rows(std::vector<PictureContest> const& contests, std::string const& peer, BenchTable& table)
{
    for (LostRows const& l : lost_rows(contests))
        table.facts.emplace_back("rows that " + l.method + " loses to " + peer,
                                 fmt::format("{} of {} (relMSE {}, FLIP {})", l.either, l.rows, l.relmse, l.flip));
}

void fill_picture_summary(std::vector<PictureContest> const& contests, std::string const& peer, BenchTable& table)
{
    add_lost_rows(contests, peer, table);
    auto const known = [](double v) { return std::isfinite(v) ? Cell(v) : Cell(); };
    for (PictureContest const& c : contests)
        table.add({c.scene, c.budget, c.filter, c.method, known(c.relmse_ratio), known(c.flip_ratio),
                   known(c.time_ratio), std::string(c.lost() ? "lost" : ""), known(c.relmse_time_factor),
                   std::string(to_text(c.relmse_reached)), known(c.flip_time_factor),
                   std::string(to_text(c.flip_reached))});
}

} // namespace viewer
