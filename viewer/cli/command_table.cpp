#include "viewer/cli/command_table.h"

#include <algorithm>
#include <stdexcept>

namespace viewer {
namespace {

constexpr std::string_view kLauncher = "lightwell", kRender = "lightwell-render", kBench = "lightwell-bench",
                           kView = "lightwell-view", kStudy = "lightwell-study", kTrials = "lightwell-trials",
                           kAr = "lightwell-ar", kBatch = "lightwell-batch";

/// In the order of --help. A subcommand belongs to the program of its group unless it has its own row.
constexpr CommandRow kCommands[]{
    {"render", kRender, "Render a scene to a picture with an error estimate."},
    {"view", kView, "Walk through a scene: window, stereo, recording, remote control."},
    {"compare", kRender, "Measure the error of a picture against a reference."},
    {"denoise", kRender, "Filter a picture that was saved without a filter."},
    {"info", kRender, "Show what a scene contains and what will be built for it, and why."},
    {"generate", kRender, "Generate a built-in scene or a sky and save it."},
    {"recording", kView, "Inspect or export a recorded walk."},
    {"remote", kView, "Send requests to a running viewer and print its answers."},
    {"track", kView, "Test trackers: listen, send, walk."},
    {"display", kView, "Displays of walls, windows, users and trackers: check, import, calibrate."},
    {"avatar", kView, "Propose which joints of a model are head, arms and legs."},
    {"xr", kView, "Show the OpenXR runtime and headset."},
    {"study", kStudy, "Experiments from a script: check, plan, run, simulate, analyze, report."},
    {"study check", kTrials, "Check a script: make every participant's plan and report all problems."},
    {"study run", kTrials, "Run a session with a participant, in a window, on walls or in a headset."},
    {"study control", kTrials, "Open the experimenter's window: progress, pause, skip, abort, notes."},
    {"study prepare", kTrials,
     "Render the stimuli of blocks with `stimuli: prepared` in advance; existing ones are kept."},
    {"study calibrate", kTrials, "Measure a display: luminance, gamma, size, distance; write its display model."},
    {"ar", kAr, "Augmented reality: add virtual objects to camera frames."},
    {"bench", kBench, "Compare methods by time and error, and report the results."},
    {"bench shown", kView,
     "Measure what the viewer shows while a head moves: intervals, age of light, FLIP, flicker."},
    {"batch", kBatch, "Run many tasks of a manifest: on this machine, under mpirun, on HyperQueue."},
    {"help", kLauncher, "Show the help of a command: lightwell help render."},
    {"completion", kLauncher, "Print a script with which a shell completes commands, options and values."},
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
