#pragma once
// Records of a render: metadata of the picture, and statistics.

#include "gi/scene/model/plan.h"
#include "viewer/offline/render_options.h"

#include <map>
#include <nlohmann/json.hpp>

namespace viewer {

/// Metadata of the picture: only what determines its values, not threads, times or output names, so that equal
/// pictures are equal files.
std::map<std::string, std::string> make_metadata(RenderOptions const& options, gi::RenderSettings const& settings,
                                                 gi::RenderResult const& result);

/// Stop condition as an option: "--paths 64", "--budget 2s" or "--until relmse=0.01".
std::string stop_option(gi::RenderSettings const& settings);

/// Choice of the plan for a picture: the settings as options; the method, if another was to choose it, and why.
struct Chosen {
    std::string options, method, why_method;
};
inline Chosen chosen_of(gi::RenderResult const& r) { return {r.options, r.method, r.why_method}; }

/// The call, for --stats and --json: schema, program, command, settings and outputs.
/// @param amount  stop condition as an option
nlohmann::ordered_json describe_call(RenderOptions const& options, gi::RenderSettings const& settings,
                                     std::string const& amount, Chosen const& chosen);
char const* end_text(gi::RenderEnd end);
/// Estimated relMSE; null if unknown, as with one path.
nlohmann::ordered_json relmse_json(gi::RenderResult const& result);

/// Statistics for --stats and --json; `lightwell render --help` lists the keys. Unknown values are null.
nlohmann::ordered_json make_stats(RenderOptions const& options, gi::RenderSettings const& settings,
                                  gi::ScenePlan const& plan, gi::RenderResult const& result,
                                  gi::Report const& report);

/// A list with the name, what, build, reason and numbers of each item, as common.schema.json says.
nlohmann::ordered_json to_json(std::vector<gi::PlanItem> const& plan);

/// Summary of the render in one line.
std::string summary_line(RenderOptions const& options, gi::RenderSettings const& settings,
                         gi::RenderResult const& result);

} // namespace viewer
