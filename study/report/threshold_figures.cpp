#include "gi/core/html/html.h"
#include "gi/core/html/plot.h"
#include "study/analysis/shown.h"
#include "study/report/figures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
std::string curve_figure(CurveResult const& c, BlockResult const& block, std::string const& setting, double truth)
{
    if (c.counts.empty()) return {};
    std::vector<double> levels;
    double most = 1;
    for (LevelCount const& l : c.counts) {
        levels.push_back(l.level);
        most = std::max(most, l.trials);
    }
    gi::PlotAxis const axis = gi::axis_over(levels, block.is_log);
    gi::Plot p(460, 320, axis, {0, 1.04, false});
    p.margins(54, 12, 16, 46);
    p.x_axis(setting);
    p.y_axis("proportion correct");
    Interval const& band = c.threshold.interval;
    if (std::isfinite(band.low) || std::isfinite(band.high)) { // an open end goes to the border
        double const from = std::isfinite(band.low) ? std::max(p.left(), p.x(band.low)) : p.left(),
                     to = std::isfinite(band.high) ? p.x(band.high) : p.right();
        p.box(from, p.top(), to - from, p.bottom() - p.top(), "band");
    }
    if (std::isfinite(c.threshold.value)) {
        p.line(p.x(c.threshold.value), p.y(c.proportion), p.x(c.threshold.value), p.bottom(), "mark");
        p.line(p.left(), p.y(c.proportion), p.x(c.threshold.value), p.y(c.proportion), "mark");
    }
    if (std::isfinite(truth)) p.diamond(p.x(truth), p.bottom() - 7, 6, "truth");
    std::vector<std::pair<double, double>> line;
    for (int i = 0; i <= 100; ++i) {
        double const share = i / 100.0;
        double const level = block.is_log ? axis.low * std::pow(axis.high / axis.low, share)
                                          : axis.low + share * (axis.high - axis.low);
        line.emplace_back(level, proportion_at(c.shape, c.parameters, level));
    }
    p.curve(line, "fit");
    for (LevelCount const& l : c.counts) {
        Interval const i = wilson(l.correct, l.trials);
        p.line(p.x(l.level), p.y(i.low), p.x(l.level), p.y(i.high), "interval thin");
        p.dot(p.x(l.level), p.y(l.correct / l.trials), 2 + 4 * std::sqrt(l.trials / most), "point");
    }
    return p.figure("psychometric function, " + c.cell,
                    fmt::format("<b>{}</b> {:.0f} % correct at {}; {}; {} observers{}", gi::escaped(c.cell),
                                100 * c.proportion, shown_estimate(c.threshold.value, band.low, band.high),
                                gi::escaped(c.function), c.observers,
                                c.note.empty() ? "" : ". Doubtful: " + gi::escaped(c.note)));
}

std::string tracks_figure(std::vector<ThresholdRun> const& runs, BlockResult const& block,
                          std::string const& title, double truth)
{
    constexpr std::size_t kMost = 24;
    if (runs.empty()) return {};
    std::vector<double> levels{truth};
    std::size_t trials = 2;
    for (ThresholdRun const& r : runs) {
        levels.insert(levels.end(), r.levels.begin(), r.levels.end());
        trials = std::max(trials, r.levels.size());
    }
    gi::PlotAxis const y = gi::axis_over(levels, block.is_log);
    std::string html;
    for (std::size_t k = 0; k < std::min(kMost, runs.size()); ++k) {
        ThresholdRun const& r = runs[k];
        gi::Plot p(216, 150, {0, double(trials) + 1, false}, y);
        p.margins(46, 20, 6, 22);
        for (double const v : y.ticks(3)) {
            p.line(p.left(), p.y(v), p.right(), p.y(v), "grid");
            p.text(p.left() - 5, p.y(v) + 4, gi::short_number(v), "end", "tick");
        }
        p.text(p.right(), p.bottom() + 16, fmt::format("{} trials", r.levels.size()), "end", "tick");
        p.text(p.left(), 14, r.participant + (r.run > 1 ? fmt::format(", run {}", r.run) : ""), "start", "label");
        std::vector<std::pair<double, double>> line;
        for (std::size_t i = 0; i < r.levels.size(); ++i) line.emplace_back(p.x(double(i) + 1), p.y(r.levels[i]));
        p.polyline(line, "track");
        for (ThresholdEstimate const& e : r.estimates)
            if (&e == &r.estimates.front() && std::isfinite(e.level.value))
                p.line(p.left(), p.y(e.level.value), p.right(), p.y(e.level.value), "mark");
        for (std::size_t i = 0; i < r.levels.size(); ++i)
            p.dot(line[i].first, line[i].second, 2.2, r.correct[i] ? "right" : "wrong");
        if (std::isfinite(truth)) p.diamond(p.right() - 5, p.y(truth), 4, "truth");
        html += p.svg(fmt::format("{}, {}", title, r.participant));
    }
    std::string const more =
        runs.size() > kMost ? fmt::format(" The first {} of {} runs.", kMost, runs.size()) : "";
    return "<figure class=\"wide\"><figcaption><b>" + gi::escaped(title) +
           "</b> Filled: correct, open: wrong; dashed: the run's estimate." + more +
           "</figcaption><div class=\"small\">" + html + "</div></figure>\n";
}

std::string thresholds_figure(std::vector<ThresholdSummary> const& thresholds, BlockResult const& block,
                              std::vector<double> const& truth, std::string const& title)
{
    if (thresholds.empty()) return {};
    std::vector<double> values = truth;
    std::vector<std::string> names;
    for (ThresholdSummary const& t : thresholds) {
        values.insert(values.end(), {t.level.value, t.level.interval.low, t.level.interval.high});
        names.push_back(fmt::format("{}, {} at {:.0f} %", t.procedure, t.method, 100 * t.proportion));
    }
    gi::RowPlot p(names, gi::axis_over(values, block.is_log), "level", 280);
    for (std::size_t k = 0; k < names.size(); ++k) {
        Uncertain const& level = thresholds[k].level;
        p.estimate(level.value, level.interval.low, level.interval.high, p.row(k));
        if (k < truth.size() && std::isfinite(truth[k])) p.diamond(p.x(truth[k]), p.row(k), 6, "truth");
    }
    return p.figure(title, "<b>" + gi::escaped(title) + "</b>");
}

std::string detections_figure(std::vector<DetectionResult> const& detections, double guess,
                              std::string const& title)
{
    if (detections.empty()) return {};
    std::vector<std::string> names;
    for (DetectionResult const& d : detections) names.push_back(d.condition);
    gi::RowPlot p(names, {0, 1.02}, "proportion correct", 280);
    if (guess > 0) p.line(p.x(guess), p.top(), p.x(guess), p.bottom(), "mark");
    for (std::size_t k = 0; k < names.size(); ++k) {
        DetectionResult const& d = detections[k];
        p.estimate(d.correct / d.trials, d.interval.low, d.interval.high, p.row(k));
    }
    return p.figure(title,
                    "<b>" + gi::escaped(title) + "</b> Wilson's intervals of all trials; dashed: guessing.");
}

std::string histogram(std::vector<double> const& values, std::string const& label, std::string const& title)
{
    std::vector<double> known;
    for (double const v : values)
        if (std::isfinite(v)) known.push_back(v);
    if (known.size() < 2) return {};
    std::sort(known.begin(), known.end());
    if (known.front() == known.back()) return {};
    // Up to the 99th percentile; the caption counts the values beyond.
    double const low = known.front(), end = known[std::size_t(0.99 * double(known.size() - 1))];
    double const high = end - low > 1e-4 * std::abs(low) ? end : low + std::max(1e-3, std::abs(low) * 0.1);
    constexpr int kBins = 30;
    std::vector<int> counts(kBins, 0);
    int beyond = 0;
    for (double const v : known)
        v > high ? ++beyond : ++counts[std::size_t(std::min(kBins - 1, int((v - low) / (high - low) * kBins)))];
    double const most = *std::max_element(counts.begin(), counts.end());
    gi::Plot p(380, 220, {low, high, false}, {0, most * 1.05, false});
    p.margins(52, 10, 16, 46);
    p.x_axis(label, 4);
    p.y_axis("", 3);
    for (int b = 0; b < kBins; ++b) {
        double const from = low + (high - low) * b / kBins, to = low + (high - low) * (b + 1) / kBins;
        double const top = p.y(counts[std::size_t(b)]);
        p.box(p.x(from) + 0.5, top, p.x(to) - p.x(from) - 1, p.bottom() - top, "bar");
    }
    return p.figure(title, fmt::format("<b>{}</b> {} values{}", gi::escaped(title), known.size(),
                                       beyond ? fmt::format(", {} beyond the plot", beyond) : ""));
}

std::string transitions_table(TransitionResult const& t)
{
    auto const n = t.names.size();
    if (n < 2 || n > 12) return {};
    int const most = std::max(1, *std::max_element(t.counts.begin(), t.counts.end()));
    std::vector<std::vector<gi::ShadedCell>> cells(n);
    for (std::size_t i = 0; i < n * n; ++i)
        cells[i / n].push_back({std::to_string(t.counts[i]), 0.5 * t.counts[i] / most});
    return gi::html_figure(
        gi::html_matrix(t.block + ": " + t.subject, t.names, cells),
        fmt::format("Neighbours that differ: {:.0f} %, by chance {:.0f} %", 100 * t.switched, 100 * t.by_chance));
}

} // namespace study
