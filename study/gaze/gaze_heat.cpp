#include "study/gaze/gaze_heat.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {

std::vector<ConditionHeat> condition_heat(GazeAnalysis const& analysis, double sd_deg, int width)
{
    std::vector<ConditionHeat> maps;
    std::vector<std::vector<HeatSource>> sources;
    std::vector<std::string> names;
    for (auto const& a : analysis.recordings)
        for (ViewedGaze const& v : a->views) {
            if (!v.view->is_counted || !v.is_usable) continue;
            auto const same = [&](ConditionHeat const& m) {
                return m.block == v.view->block && m.condition == v.view->condition &&
                       m.screen == a->recording.screen;
            };
            auto const found = std::find_if(maps.begin(), maps.end(), same);
            std::size_t const at = std::size_t(found - maps.begin());
            if (found == maps.end()) {
                names.push_back(label_of("heat" + v.view->block + v.view->condition, names));
                maps.push_back(
                    {names.back(), v.view->block, v.view->condition, a->recording.screen, 0, 0, sd_deg, {}});
                sources.emplace_back();
            }
            ++maps[at].views;
            for (SeenFixation const& f : v.fixations) {
                maps[at].seconds += f.dwell_s;
                sources[at].push_back({f.fixation->x_px, f.fixation->y_px, f.dwell_s});
            }
        }
    for (std::size_t i = 0; i < maps.size(); ++i)
        maps[i].map = heat_map(sources[i], maps[i].screen, sd_deg, width);
    return maps;
}

ResultTable heat_table(std::vector<ConditionHeat> const& maps)
{
    ResultTable t{"heat_maps", "Heat maps", "Where fixations were, weighted by their time.", false, {}};
    t.table.columns = {name_column("file", "Name of the picture, without .png"),
                       name_column("block", "Block, or the task of a file"),
                       name_column("condition", "Levels of the factors of each stimulus"),
                       name_column("screen", "Screen that the picture shows"),
                       {"views", "Views that count and have enough valid samples"},
                       {"seconds", "Time of the fixations in them", "s"},
                       {"beside_s", "Of it, with the gaze beside the screen", "s"},
                       {"sd_deg", "Standard deviation of the Gaussian", "deg"},
                       {"most_s_per_deg2", "Density that is white; colours follow its square root", "s/deg2"}};
    for (ConditionHeat const& m : maps)
        t.table.rows.push_back({cell(m.file), cell(m.block), cell(m.condition),
                                cell(fmt::format("{} x {} px, {:g} cm away", m.screen.width_px, m.screen.height_px,
                                                 m.screen.distance_cm)),
                                cell(m.views), cell(m.seconds), cell(m.map.outside), cell(m.sd_deg),
                                cell(m.map.most)});
    return t;
}

} // namespace study
