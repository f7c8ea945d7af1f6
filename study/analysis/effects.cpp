#include "study/analysis/whole.h"

#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace study {
namespace {

using Cell = std::vector<int>;

/// Means of observers by cell, after axes without variation are removed.
struct CellTable {
    std::vector<MeasureAxis> axes;
    std::vector<Cell> cells; ///< all combinations, the last axis varying fastest, or those that exist
    bool is_crossed = true;
    std::vector<std::string> participants;
    std::vector<std::map<Cell, double>> means; ///< by participant
    int relative_to = -1;                      ///< as Measure
};

std::string name_of(CellTable const& t, Cell const& cell)
{
    std::string name;
    for (std::size_t a = 0; a < cell.size(); ++a)
        name += (a ? " " : "") + t.axes[a].name + "=" + t.axes[a].levels[std::size_t(cell[a])];
    return name.empty() ? "all" : name;
}

CellTable table_of(Measure const& m)
{
    CellTable t;
    std::vector<std::size_t> kept;
    std::vector<std::vector<int>> used; // levels that occur, by kept axis
    for (std::size_t a = 0; a < m.axes.size(); ++a) {
        std::set<int> found;
        for (Observation const& o : m.observations) found.insert(o.levels[a]);
        if (found.size() < 2) continue;
        if (int(a) == m.relative_to) t.relative_to = int(kept.size());
        kept.push_back(a);
        used.emplace_back(found.begin(), found.end());
        MeasureAxis axis{m.axes[a].name, {}};
        for (int const l : found) axis.levels.push_back(m.axes[a].levels[std::size_t(l)]);
        t.axes.push_back(std::move(axis));
    }
    std::map<std::string, std::map<Cell, std::vector<double>>> values;
    std::set<Cell> found;
    std::vector<std::string> order;
    for (Observation const& o : m.observations) {
        Cell cell;
        for (std::size_t k = 0; k < kept.size(); ++k) {
            auto const it = std::find(used[k].begin(), used[k].end(), o.levels[kept[k]]);
            cell.push_back(int(it - used[k].begin()));
        }
        found.insert(cell);
        if (!values.count(o.participant)) order.push_back(o.participant);
        values[o.participant][cell].push_back(o.value);
    }
    t.cells.assign(found.begin(), found.end());
    std::size_t combinations = 1;
    for (MeasureAxis const& a : t.axes) combinations *= a.levels.size();
    t.is_crossed = combinations == t.cells.size() && t.axes.size() <= 4;
    for (std::string const& p : order) {
        t.participants.push_back(p);
        t.means.emplace_back();
        for (auto const& [cell, list] : values[p]) t.means.back()[cell] = mean(list);
    }
    return t;
}

/// The between factors that vary among the given participants, for the analysis of variance.
std::vector<BetweenFactor> between_of(std::vector<ParticipantFactor> const& groups,
                                      std::vector<std::string> const& participants)
{
    std::vector<BetweenFactor> out;
    for (ParticipantFactor const& g : groups) {
        std::map<int, int> found; // level -> place among those that occur
        for (std::string const& p : participants) found[g.level.at(p)] = 0;
        int next = 0;
        for (auto& [unused, place] : found) place = next++;
        if (found.size() < 2) continue;
        BetweenFactor f{g.name, int(found.size()), {}};
        for (std::string const& p : participants) f.level.push_back(found[g.level.at(p)]);
        out.push_back(std::move(f));
    }
    return out;
}

void test_variance(Measure const& m, CellTable const& t, std::vector<ParticipantFactor> const& groups,
                   AnalysisSettings const& settings, Analysis& a)
{
    std::vector<std::string> complete;
    Matrix cells;
    cells.columns = t.cells.size();
    for (std::size_t o = 0; o < t.participants.size(); ++o) {
        bool const is_known = std::all_of(groups.begin(), groups.end(), [&](ParticipantFactor const& g) {
            return g.level.count(t.participants[o]) > 0;
        });
        if (!is_known || t.means[o].size() < t.cells.size()) continue;
        complete.push_back(t.participants[o]);
        for (Cell const& c : t.cells) cells.values.push_back(t.means[o].at(c));
    }
    cells.rows = complete.size();
    int const left_out = int(t.participants.size() - complete.size());
    if (left_out > 0)
        a.effect_notes.push_back(
            {m.block, m.name,
             left_out == 1
                 ? "1 observer lacks a cell and is not in the tests of effects"
                 : fmt::format("{} observers lack a cell and are not in the tests of effects", left_out)});
    MixedDesign design;
    if (t.is_crossed)
        for (MeasureAxis const& axis : t.axes) design.within.push_back({axis.name, int(axis.levels.size())});
    else if (t.cells.size() > 1)
        design.within.push_back({"condition", int(t.cells.size())});
    design.between = between_of(groups, complete);
    if (design.within.empty() && design.between.empty()) return;
    try {
        if (complete.empty()) throw std::invalid_argument("no observer has all cells");
        auto effects = mixed_anova(cells, design, {settings.permutations, settings.seed, settings.confidence});
        // Effects that average over items whose mean is 0 by definition do not exist.
        if (t.relative_to >= 0 && t.is_crossed)
            std::erase_if(effects, [&](AnovaEffect const& e) {
                return (" " + e.name + " ").find(" " + t.axes[std::size_t(t.relative_to)].name + " ") ==
                       std::string::npos;
            });
        for (AnovaEffect const& e : effects)
            if (!e.is_tested)
                a.effect_notes.push_back(
                    {m.block, m.name,
                     fmt::format(
                         "no test of '{}': there is no variation within groups, every observer shows the same "
                         "effect",
                         e.name)});
        std::erase_if(effects, [](AnovaEffect const& e) { return !e.is_tested; });
        std::vector<double> p;
        for (AnovaEffect const& e : effects) p.push_back(e.p_gg);
        std::vector<double> const corrected = holm(p);
        for (std::size_t i = 0; i < effects.size(); ++i)
            a.effects.push_back(
                {m.block, m.name, effects[i].name, int(complete.size()), effects[i], corrected[i]});
    } catch (std::invalid_argument const& e) {
        a.effect_notes.push_back({m.block, m.name, std::string("no analysis of variance: ") + e.what()});
    }
}

void test_groups(Measure const& m, CellTable const& t, ParticipantFactor const& g,
                 AnalysisSettings const& settings, Analysis& a)
{
    // Columns: the mean over all cells of complete observers, then each cell.
    std::vector<std::pair<std::string, std::vector<std::vector<double>>>> columns;
    auto const add = [&](std::string const& name, auto const& value_of) {
        std::vector<std::vector<double>> values(g.levels.size(), std::vector<double>{});
        for (std::size_t o = 0; o < t.participants.size(); ++o) {
            auto const level = g.level.find(t.participants[o]);
            double const v = value_of(t.means[o]);
            if (level != g.level.end() && std::isfinite(v)) values[std::size_t(level->second)].push_back(v);
        }
        columns.emplace_back(name, std::move(values));
    };
    if (t.relative_to < 0)
        add("mean", [&](std::map<Cell, double> const& means) {
            if (means.size() < t.cells.size()) return kUnknown;
            std::vector<double> all;
            for (auto const& [unused, v] : means) all.push_back(v);
            return mean(all);
        });
    if (t.cells.size() > 1)
        for (Cell const& c : t.cells)
            add(name_of(t, c), [&](std::map<Cell, double> const& means) {
                auto const it = means.find(c);
                return it == means.end() ? kUnknown : it->second;
            });
    std::vector<GroupDifference> found;
    std::vector<double> p;
    for (auto const& [cell, values] : columns)
        for (std::size_t i = 0; i < g.levels.size(); ++i)
            for (std::size_t j = i + 1; j < g.levels.size(); ++j) try {
                    if (values[i].empty() && values[j].empty()) continue;
                    found.push_back({m.block, m.name, cell, g.name + "=" + g.levels[i], g.name + "=" + g.levels[j],
                                     welch_test(values[i], values[j], settings.confidence)});
                    p.push_back(found.back().test.p);
                } catch (std::invalid_argument const& e) {
                    a.effect_notes.push_back({m.block, m.name,
                                              fmt::format("{}: {}={} and {} not compared: {}", cell, g.name,
                                                          g.levels[i], g.levels[j], e.what())});
                }
    std::vector<double> const corrected = holm(p);
    for (std::size_t i = 0; i < found.size(); ++i) {
        found[i].p_holm = corrected[i];
        a.group_differences.push_back(std::move(found[i]));
    }
}

} // namespace

void test_effects(Measure const& measure, std::vector<ParticipantFactor> const& groups,
                  AnalysisSettings const& settings, Analysis& analysis)
{
    if (measure.observations.empty()) return;
    CellTable const t = table_of(measure);
    if (t.participants.size() < 3) return; // nothing about a population
    test_variance(measure, t, groups, settings, analysis);
    for (ParticipantFactor const& g : groups) test_groups(measure, t, g, settings, analysis);
}

} // namespace study
