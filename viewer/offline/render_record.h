#pragma once
// What is written down about a render: in the picture itself, and in the statistics.

#include "gi/scene/model/plan.h"
#include "viewer/offline/render_options.h"

#include <map>
#include <nlohmann/json.hpp>

namespace viewer {

/// Metadata of the picture. Only what decides its values, not threads, times or names of outputs: equal pictures
/// are equal files.
std::map<std::string, std::string> make_metadata(RenderOptions const& options, gi::RenderSettings const& settings,
                                                 gi::RenderResult const& result);

/// When to stop, as an option: "--paths 64", "--budget 2s" or "--until relmse=0.01".
std::string stop_option(gi::RenderSettings const& settings);

/// What --stats and --json say of the call: schema, program, command, settings and outputs.
/// @param amount an option as above   @param chosen what the method chose for itself, as options
nlohmann::ordered_json describe_call(RenderOptions const& options, gi::RenderSettings const& settings,
                                     std::string const& amount, std::string const& chosen);
nlohmann::ordered_json to_json(gi::ScenePlan const& plan);
char const* end_text(gi::RenderEnd end);
/// Null where one path says nothing about its variance.
nlohmann::ordered_json relmse_json(gi::RenderResult const& result);

/// For --stats and --json; the keys are listed in `lightwell render --help`. Values that are not known are null.
nlohmann::ordered_json make_stats(RenderOptions const& options, gi::RenderSettings const& settings,
                                  gi::ScenePlan const& plan, gi::RenderResult const& result,
                                  gi::Report const& report);

/// One line for people.
std::string summary_line(RenderOptions const& options, gi::RenderSettings const& settings,
                         gi::RenderResult const& result);

} // namespace viewer
