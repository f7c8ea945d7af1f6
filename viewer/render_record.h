#pragma once
// What is written down about a render: in the picture itself, and in the statistics.

#include "gi/scene/plan.h"
#include "viewer/render_options.h"

#include <map>
#include <nlohmann/json.hpp>

namespace viewer {

/// Metadata of the picture. Only what decides its values, not threads, times or names of outputs: equal pictures
/// are equal files.
std::map<std::string, std::string> make_metadata(RenderOptions const& options, gi::RenderSettings const& settings,
                                                 gi::RenderResult const& result);

/// For --stats and --json; the keys are listed in `lightwell render --help`. Values that are not known are null.
nlohmann::ordered_json make_stats(RenderOptions const& options, gi::RenderSettings const& settings,
                                  gi::ScenePlan const& plan, gi::RenderResult const& result,
                                  gi::Report const& report);

/// One line for people.
std::string summary_line(RenderOptions const& options, gi::RenderSettings const& settings,
                         gi::RenderResult const& result);

} // namespace viewer
