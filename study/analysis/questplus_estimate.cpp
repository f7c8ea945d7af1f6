// The threshold by QUEST+'s own posterior: that of the level at which the proportion of answers is right.

#include "study/analysis/threshold_run.h"
#include "study/numeric/root.h"
#include "study/numeric/rounding.h"
#include "study/script/procedure_settings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

struct LevelShare {
    double at = 0, probability = 0;
};

/// Where a proportion of the posterior lies below, between the middles of cells in the order of `at`; infinite
/// within the part that is infinite.
double quantile_of(std::vector<LevelShare> const& cells, double proportion)
{
    double below = 0, last = -INFINITY, at_last = 0;
    for (LevelShare const& c : cells) {
        if (c.at == INFINITY) return proportion < below ? last : c.at;
        double const middle = below + c.probability / 2;
        below += c.probability;
        if (std::isinf(c.at)) {
            if (proportion <= below) return c.at;
            continue;
        }
        if (middle >= proportion)
            return std::isinf(last) ? c.at : std::lerp(last, c.at, (proportion - at_last) / (middle - at_last));
        last = c.at;
        at_last = middle;
    }
    return last;
}

QuestPlus replayed(ThresholdRun const& run, QuestSettings const& s, auto const& on_axis)
{
    QuestPlus quest(s);
    for (std::size_t i = 0; i < run.levels.size(); ++i) {
        double const shown = on_axis(run.levels[i]);
        auto const nearest = std::min_element(s.stimuli.begin(), s.stimuli.end(), [&](double x, double y) {
            return std::abs(x - shown) < std::abs(y - shown);
        });
        quest.respond(std::size_t(nearest - s.stimuli.begin()), run.correct[i] != 0);
    }
    return quest;
}

/// Says where the posterior of the threshold is cut by its prior: what lies beyond was excluded before the first trial.
std::string note_of_cut(QuestPlus const& quest, auto const& to_level)
{
    QuestSettings const& s = quest.settings();
    std::map<double, double> posterior; // by level, where the prior is not 0
    for (std::size_t i = 0; i < s.threshold.size(); ++i)
        if (s.threshold_prior.empty() || s.threshold_prior[i] > 0) posterior[to_level(s.threshold[i])] = 0;
    for (std::size_t i = 0; i < quest.posterior().size(); ++i)
        if (auto const at = posterior.find(to_level(quest.parameters(i).threshold)); at != posterior.end())
            at->second += quest.posterior()[i];
    std::vector<double> values;
    for (auto const& [unused, v] : posterior) values.push_back(v);
    std::string const end = cut_end(values);
    if (end.empty()) return {};
    return fmt::format("the posterior is cut at the {} end of the prior of the threshold, {:.4g} to {:.4g}: the "
                       "threshold may lie "
                       "beyond",
                       end, posterior.begin()->first, posterior.rbegin()->first);
}

} // namespace

ThresholdEstimate questplus_estimate(ThresholdRun const& run, Block const& b, Procedure const& p,
                                     double proportion, AnalysisSettings const& settings)
{
    Compare const& c = *b.compare;
    ThresholdEstimate e{"QUEST+ posterior", proportion, {}, {}};
    if (p.has_one_point()) {
        e.note = "the prior has one point: nothing was learned";
        return e;
    }
    bool const takes_levels = assumed_function(p).takes_levels();
    auto const on_axis = [&](double level) { return takes_levels ? level : to_scale(c.scale, level); };
    try {
        QuestPlus const quest = replayed(run, quest_settings(p, c), on_axis);
        double const width = to_scale(c.scale, c.high) - to_scale(c.scale, c.low);
        double low = to_scale(c.scale, c.low) - width;
        double const high = to_scale(c.scale, c.high) + width;
        if (c.scale == Scale::linear && takes_levels) low = std::max(low, 1e-6 * width); // none below 0
        std::vector<LevelShare> cells;
        for (std::size_t i = 0; i < quest.posterior().size(); ++i) {
            double const probability = quest.posterior()[i];
            if (probability < 1e-12) continue;
            auto const above = [&](double at) {
                return proportion_by(quest.settings(), quest.parameters(i), on_axis(from_scale(c.scale, at))) -
                       proportion;
            };
            double const at_low = above(low), at_high = above(high);
            // Flat functions, and formulas that rise far beyond the levels, go the way of the design.
            bool const rises = at_low == at_high ? !c.harder_up : at_low < at_high;
            double const sign = rises ? 1 : -1;
            // Functions that never reach the proportion have their threshold beyond the last level.
            double const at = sign * at_low >= 0    ? -INFINITY
                              : sign * at_high <= 0 ? INFINITY
                                                    : bisect([&](double x) { return sign * above(x); }, low, high);
            cells.push_back({at, probability});
        }
        std::sort(cells.begin(), cells.end(),
                  [](LevelShare const& x, LevelShare const& y) { return x.at < y.at; });
        auto const level = [&](double part) {
            double const at = quantile_of(cells, part);
            return std::isfinite(at) ? from_scale(c.scale, at) : kUnknown;
        };
        double const tail = (1 - settings.confidence) / 2;
        if (double const median = level(0.5); std::isfinite(median)) {
            e.level = {median, {level(tail), level(1 - tail)}, 1};
            e.note = note_of_open_ends(e.level.interval, tail);
            if (is_rounding(e.level.interval.high - e.level.interval.low, std::abs(median))) {
                e.level.interval = {kUnknown, kUnknown};
                e.note = "the posterior is in one point of its grid, which tells no interval: a finer grid would";
            }
        } else
            e.note = "most functions of the posterior never reach this proportion";
        if (!run.levels.empty())
            e.doubt = note_of_cut(quest, [&](double t) { return takes_levels ? t : from_scale(c.scale, t); });
        if (!e.doubt.empty()) e.note += (e.note.empty() ? "" : "; ") + e.doubt;
    } catch (std::invalid_argument const& error) {
        e.note = error.what();
    }
    return e;
}

} // namespace study
