#include "gi/core/html/html.h"
#include "gi/core/html/plot.h"
#include "study/report/figures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace study {

ItemDifference const* difference_of(ScaleResult const& s, int a, int b)
{
    for (ItemDifference const& d : s.differences)
        if ((d.a == a && d.b == b) || (d.a == b && d.b == a)) return &d;
    return nullptr;
}

std::vector<int> by_score(ScaleResult const& s)
{
    std::vector<int> order(s.items.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return s.items[std::size_t(a)].score.value > s.items[std::size_t(b)].score.value;
    });
    return order;
}

namespace {

/// Longest runs [first, last] of sorted items in which no two differ significantly.
std::vector<std::pair<std::size_t, std::size_t>> equal_runs(ScaleResult const& s, std::vector<int> const& order)
{
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t first = 0; first < order.size(); ++first) {
        std::size_t last = first;
        for (; last + 1 < order.size(); ++last) {
            bool is_equal = true;
            for (std::size_t i = first; i <= last && is_equal; ++i) {
                auto const* d = difference_of(s, order[i], order[last + 1]);
                is_equal = d == nullptr || !(d->p_holm < 0.05);
            }
            if (!is_equal) break;
        }
        if (last > first && (runs.empty() || last > runs.back().second)) runs.emplace_back(first, last);
    }
    return runs;
}

struct Rectangle {
    double x1, y1, x2, y2;
};

double overlap(Rectangle const& a, Rectangle const& b)
{
    double const w = std::min(a.x2, b.x2) - std::max(a.x1, b.x1), h = std::min(a.y2, b.y2) - std::max(a.y1, b.y1);
    return w > 0 && h > 0 ? w * h : 0;
}

/// Position beside a point where a text overlaps least.
Rectangle free_spot(gi::Plot const& p, double x, double y, double width, std::vector<Rectangle> const& taken)
{
    constexpr double kHeight = 15;
    Rectangle best{};
    double least = 1e300;
    for (double const dy : {-14.0, 0.0, 14.0, -26.0, 26.0, -40.0, 40.0})
        for (double const tx : {x + 14, x - 14 - width, x - width / 2}) {
            Rectangle const r{tx, y + dy - kHeight / 2, tx + width, y + dy + kHeight / 2};
            bool const is_inside =
                r.x1 >= p.left() && r.x2 <= p.right() + 10 && r.y1 >= p.top() - 8 && r.y2 <= p.bottom();
            double cost = 0.02 * std::abs(dy) + (is_inside ? 0 : 1e6);
            for (Rectangle const& t : taken) cost += overlap(r, t);
            if (cost < least) {
                least = cost;
                best = r;
            }
        }
    return best;
}

std::vector<std::string> names_of(ScaleResult const& s, std::vector<int> const& order)
{
    std::vector<std::string> names;
    for (int const i : order) names.push_back(s.items[std::size_t(i)].name);
    return names;
}

} // namespace

std::string scale_figure(ScaleResult const& s, std::vector<double> const& truth, Interval const& shared,
                         std::string const& title)
{
    if (!s.refused.empty() || s.items.empty()) return {};
    auto const order = by_score(s);
    auto const runs = equal_runs(s, order);
    // Space for four bars, so that axes are equal.
    gi::RowPlot p(names_of(s, order), gi::axis_over({shared.low, shared.high}), s.unit, 254,
                  12 + 10 * double(std::max<std::size_t>(4, runs.size())));
    for (std::size_t k = 0; k < order.size(); ++k) {
        Uncertain const& score = s.items[std::size_t(order[k])].score;
        p.estimate(score.value, score.interval.low, score.interval.high, p.row(k));
        if (!truth.empty() && std::isfinite(truth[std::size_t(order[k])]))
            p.diamond(p.x(truth[std::size_t(order[k])]), p.row(k), 6, "truth");
    }
    for (std::size_t k = 0; k < runs.size(); ++k) {
        double const x = p.right() + 10 + 10 * double(k);
        p.line(x, p.row(runs[k].first) - 6, x, p.row(runs[k].second) + 6, "equal");
    }
    return p.figure(title + ": scores", fmt::format("<b>{}</b> {} observers, {} judgements", gi::escaped(title),
                                                    s.observers, s.observations));
}

std::string cost_figure(ScaleResult const& s, std::string const& title)
{
    std::vector<double> costs, scores;
    for (ScaledItem const& i : s.items) {
        if (!(i.render_ms.value > 0)) continue;
        double const least = std::max(0.0, i.render_ms.interval.low); // no time is below 0, whatever Student says
        costs.insert(costs.end(), {i.render_ms.value, least, i.render_ms.interval.high});
        scores.insert(scores.end(), {i.score.value, i.score.interval.low, i.score.interval.high});
    }
    if (!s.refused.empty() || costs.size() < 6) return {};
    auto const [low, high] = std::minmax_element(costs.begin(), costs.end());
    gi::Plot p(550, 350, gi::axis_over(costs, *low > 0 && *high > 5 * *low, 0.12),
               gi::axis_over(scores, false, 0.1));
    p.margins(56, 12, 20, 46);
    p.x_axis("rendering time per frame, ms");
    p.y_axis(s.unit);
    std::vector<Rectangle> taken;
    for (ScaledItem const& item : s.items) {
        if (!(item.render_ms.value > 0)) continue;
        double const x = p.x(item.render_ms.value), y = p.y(item.score.value);
        taken.push_back({x - 10, y - 10, x + 10, y + 10});
        if (std::isfinite(item.score.interval.low))
            taken.push_back({x - 2, p.y(item.score.interval.high), x + 2, p.y(item.score.interval.low)});
    }
    for (std::size_t i = 0; i < s.items.size(); ++i) {
        ScaledItem const& item = s.items[i];
        if (!(item.render_ms.value > 0)) continue;
        double const x = p.x(item.render_ms.value), y = p.y(item.score.value);
        bool const is_chosen = s.cheapest && s.cheapest->item == int(i);
        bool const is_base = s.cheapest && s.cheapest->against == int(i);
        if (std::isfinite(item.score.interval.low))
            p.line(x, p.y(item.score.interval.low), x, p.y(item.score.interval.high), "interval");
        if (std::isfinite(item.render_ms.interval.low))
            p.line(p.x(std::max(0.0, item.render_ms.interval.low)), y, p.x(item.render_ms.interval.high), y,
                   "interval");
        if (is_chosen) p.dot(x, y, 10, "ring");
        is_base ? p.box(x - 5, y - 5, 10, 10, "base") : p.dot(x, y, 4.5, "point");
        std::string const words = item.name + (is_base && s.cheapest->is_reference ? " (reference)" : "");
        Rectangle const spot = free_spot(p, x, y, gi::text_width(words), taken);
        taken.push_back(spot);
        p.text(spot.x1, spot.y2 - 3, words);
    }
    return p.figure(title + ": score against rendering time per frame", "<b>" + gi::escaped(title) + "</b>");
}

std::string wins_table(ScaleResult const& s, double level)
{
    if (s.wins.empty() || !s.refused.empty()) return {};
    auto const order = by_score(s);
    std::vector<std::vector<gi::ShadedCell>> cells;
    for (int const r : order) {
        cells.emplace_back();
        for (int const c : order) {
            double const won = s.wins[std::size_t(r)][std::size_t(c)],
                         lost = s.wins[std::size_t(c)][std::size_t(r)];
            cells.back().emplace_back();
            if (r == c || won + lost == 0) continue;
            double const share = won / (won + lost);
            auto const* d = difference_of(s, r, c);
            cells.back().back() = {
                fmt::format("{:.0f}{}", 100 * share, d != nullptr && d->p_holm < level ? "*" : ""), share - 0.5};
        }
    }
    return gi::html_figure(gi::html_matrix(s.group, names_of(s, order), cells), "");
}

std::string spread_figure(ScaleResult const& s, RatingScale const& rating, std::string const& title)
{
    if (s.spread.empty()) return {};
    auto const order = by_score(s);
    auto const steps = s.spread.front().size();
    gi::RowPlot p(names_of(s, order), {rating.low - 0.6 * rating.step, rating.high + 0.6 * rating.step}, s.unit,
                  330, 24, int(std::min<std::size_t>(steps, 10)) + 1);
    double const width = std::max(3.0, (p.right() - p.left()) / double(steps) - 3);
    for (std::size_t k = 0; k < order.size(); ++k) {
        auto const& counts = s.spread[std::size_t(order[k])];
        Uncertain const& score = s.items[std::size_t(order[k])].score;
        int const sum = std::max(1, std::accumulate(counts.begin(), counts.end(), 0));
        for (std::size_t v = 0; v < steps; ++v) {
            double const h = (p.kRow - 5) * std::min(1.0, double(counts[v]) / sum / 0.6);
            p.box(p.x(rating.low + double(v) * rating.step) - width / 2, p.row(k) + 10 - h, width, h, "bar");
        }
        p.estimate(score.value, score.interval.low, score.interval.high, p.row(k));
    }
    return p.figure(title + ": ratings", fmt::format("<b>{}</b> {} observers, {} ratings", gi::escaped(title),
                                                     s.observers, s.observations));
}

} // namespace study
