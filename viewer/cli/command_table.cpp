#include "viewer/cli/command_table.h"

#include <algorithm>
#include <stdexcept>

namespace viewer {
namespace {

constexpr std::string_view kRender = "lightwell-render", kView = "lightwell-view", kStudy = "lightwell-study",
                           kTrials = "lightwell-trials", kAr = "lightwell-ar";

/// As --help lists them. A command of a group comes with the group's own program unless it is named here.
constexpr CommandRow kCommands[]{
    {"render", kRender, "Render a scene to a picture with its error."},
    {"view", kView, "Walk through a scene: window, stereo, recording, remote control."},
    {"compare", kRender, "Measure how far a picture is from a reference."},
    {"info", kRender, "What is in a scene, what will be built for it, and why."},
    {"generate", kRender, "Save a scene or a sky that the program makes itself."},
    {"recording", kView, "What a recorded walk holds."},
    {"remote", kView, "Ask a running viewer to do something; prints its results."},
    {"track", kView, "Try out trackers: listen, send, walk."},
    {"display", kView, "Walls, windows, users and trackers: check, import, pictures for setting up."},
    {"xr", kView, "Headsets through OpenXR."},
    {"study", kStudy, "Experiments from a script: check, plan, run, simulate, analyze, report."},
    {"study check", kTrials, "What a script holds; every participant's plan is made, and what is wrong is said."},
    {"study run", kTrials, "A session with a participant: in a window, on walls, in a headset."},
    {"study control", kTrials, "The experimenter's window on a session: progress, pause, skip, abort, notes."},
    {"study prepare", kTrials,
     "Render ahead what blocks with `stimuli: prepared` show; what is there already is kept."},
    {"ar", kAr, "Augmented reality: virtual things in a camera's pictures"},
    {"bench", kRender, "Measure methods against each other, and report on it."},
};

CommandRow const* find(std::string_view name)
{
    auto const found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                    [&](CommandRow const& c) { return c.name == name; });
    return found == std::end(kCommands) ? nullptr : found;
}

} // namespace

std::span<CommandRow const> commands() { return kCommands; }

std::string about(std::string_view name)
{
    CommandRow const* const c = find(name);
    if (c == nullptr) throw std::logic_error("no command '" + std::string(name) + "' in the table");
    return std::string(c->about);
}

std::string_view program_of(std::string_view first, std::string_view second)
{
    CommandRow const* c = find(std::string(first) + " " + std::string(second));
    if (c == nullptr) c = find(first);
    return c == nullptr ? std::string_view() : c->program;
}

} // namespace viewer
