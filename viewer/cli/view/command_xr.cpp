#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/devices/xr/info.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {
namespace {

std::string tracked(HmdInfo const& info)
{
    std::string const gaze = info.tracks_gaze ? ", gaze" : "";
    if (info.tracks_position) return (info.tracks_rotation ? "position and rotation" : "position") + gaze;
    return (info.tracks_rotation ? "rotation" : "nothing") + gaze;
}

int run_info(bool as_json)
{
    HmdInfo const info = ask_runtime();
    if (as_json) {
        nlohmann::ordered_json const j{{"runtime", info.runtime},
                                       {"system", info.system},
                                       {"views", info.inset_width > 0 ? "primary quad" : "primary stereo"},
                                       {"width", info.width},
                                       {"height", info.height},
                                       {"widest", info.widest},
                                       {"highest", info.highest},
                                       {"inset_width", info.inset_width},
                                       {"inset_height", info.inset_height},
                                       {"tracks_position", info.tracks_position},
                                       {"tracks_rotation", info.tracks_rotation},
                                       {"tracks_gaze", info.tracks_gaze},
                                       {"blend_modes", info.blend_modes},
                                       {"extensions_used", info.extensions_used},
                                       {"extensions_missing", info.extensions_missing}};
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    fmt::print("{}\n  {:<22} {}\n  {:<22} {}\n", info.runtime, "headset", info.system, "tracks", tracked(info));
    fmt::print("  {:<22} {} x {} pixels each, at most {} x {}\n", "two views", info.width, info.height,
               info.widest, info.highest);
    if (info.inset_width > 0)
        fmt::print("  {:<22} {} x {} pixels each\n", "two insets", info.inset_width, info.inset_height);
    fmt::print("  {:<22} {}\n", "blend modes", fmt::join(info.blend_modes, ", "));
    for (std::string const& e : info.extensions_used) fmt::print("  {:<22} {}\n", "uses", e);
    for (std::string const& e : info.extensions_missing) fmt::print("  {:<22} {}\n", "is missing", e);
    std::fflush(stdout);
    return 0;
}

} // namespace

void add_xr(CLI::App& app, int& exit_code)
{
    CLI::App* const c = app.add_subcommand("xr", about("xr"));
    c->require_subcommand(1);
    auto const as_json = std::make_shared<bool>(false);
    CLI::App* const info = c->add_subcommand("info", "Print properties of the OpenXR runtime and its headset.");
    info->add_flag("--json", *as_json, "print JSON");
    info->footer(R"(Examples:
  lightwell xr info
  XR_RUNTIME_JSON=/usr/share/openxr/1/openxr_monado.json lightwell xr info --json

Exit code 2 if there is no runtime or no headset; see docs/hmd.md.)");
    c->footer("Examples:\n  lightwell xr info");
    info->callback([as_json, &exit_code] { exit_code = run_info(*as_json); });
}

} // namespace viewer
