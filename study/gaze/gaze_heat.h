#pragma once
// Heat maps of an analysis: one for each block and condition, over all participants.

#include "study/gaze/gaze_analysis.h"
#include "study/gaze/heat_map.h"
#include "study/tables/result_table.h"

namespace study {

struct ConditionHeat {
    std::string file, block, condition; ///< file: name without an ending
    ScreenGeometry screen;
    int views = 0; ///< those that count and have enough valid samples
    double seconds = 0, sd_deg = 1;
    HeatMap map;
};
/// Recordings on different screens have maps of their own. Fixations count with their time in the view.
std::vector<ConditionHeat> condition_heat(GazeAnalysis const& analysis, double sd_deg, int width);
/// A row per map, with the density that is white in its picture.
ResultTable heat_table(std::vector<ConditionHeat> const& maps);

} // namespace study
