#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/protocol/json_text.h"
#include "viewer/protocol/recording/export_csv.h"
#include "viewer/protocol/recording/frame_summary.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <set>

namespace viewer {
namespace {

using Json = nlohmann::ordered_json;

struct RecordingOptions {
    std::string file, csv;
    bool json = false;
};

Json describe(RecordingReader& reader)
{
    FrameStatistics statistics;
    std::uint64_t changes = 0, hashes = 0, timed = 0;
    std::optional<FrameCommand> first;
    FrameCommand last;
    std::set<std::string> views;
    while (auto frame = reader.next()) {
        changes += frame->command.changes.size();
        hashes += frame->pixel_hash ? 1 : 0;
        timed += frame->times ? 1 : 0;
        if (frame->times) statistics.add(*frame->times);
        for (ViewCommand const& v : frame->command.views)
            views.insert(fmt::format("{} {}x{}", v.name, v.width, v.height));
        if (!first) first = frame->command;
        last = std::move(frame->command);
    }
    RecordingHeader const& h = reader.header();
    Json j{{"recording", reader.name()}, {"bytes", reader.bytes()},        {"program", h.program},
           {"scene", h.scene},           {"command_line", h.command_line}, {"created", h.created},
           {"settings", h.settings}};
    RecordingEnd const& end = reader.end();
    j["frames"] = end.frames;
    if (first) {
        j["first_frame"] = first->frame;
        j["last_frame"] = last.frame;
        j["duration_s"] = last.pose_s - first->pose_s;
    }
    j["changes"] = changes;
    j["views"] = views;
    j["frames_with_pixel_hash"] = hashes;
    if (timed > 0) j["frame_times"] = to_json(statistics.summary());
    j["ended"] = end.state == RecordingState::finished ? "in order"
                 : end.state == RecordingState::cut    ? "cut"
                                                       : "damaged";
    j["unread_bytes"] = end.unread_bytes;
    return j;
}

void report_loss(RecordingReader const& reader)
{
    std::string const loss = describe_loss(reader.end());
    if (!loss.empty()) std::fputs(("note: " + loss + "\n").c_str(), stderr);
}

int run_info(RecordingOptions const& o)
{
    RecordingReader reader(o.file);
    Json const about = describe(reader);
    if (o.json)
        std::fputs(to_text(about).c_str(), stdout);
    else
        for (auto const& [key, value] : about.items())
            std::fputs(
                fmt::format("{:<22} {}\n", key, value.is_string() ? value.get<std::string>() : json_line(value))
                    .c_str(),
                stdout);
    report_loss(reader);
    return 0;
}

int run_export(RecordingOptions const& o)
{
    check_outputs({o.csv}, {o.file});
    RecordingReader reader(o.file);
    RecordingEnd const end = export_csv(reader, o.csv);
    fmt::print("{}: {} frames\n", o.csv, end.frames);
    report_loss(reader);
    return 0;
}

} // namespace

void add_recording(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RecordingOptions>();
    CLI::App* const c = app.add_subcommand("recording", about("recording"));
    c->require_subcommand(1);
    CLI::App* const info =
        c->add_subcommand("info", "Print scene, settings, frames, times, and whether the file is complete.");
    info->add_option("FILE", o->file, "recording made by --record")->required();
    info->add_flag("--json", o->json, "print JSON");
    info->footer(R"(Prepared by (view needs a display):
  lightwell view atrium --record walk.lwr
Examples:
  lightwell recording info walk.lwr
  lightwell recording info walk.lwr --json)");
    info->callback([o, &exit_code] { exit_code = run_info(*o); });
    CLI::App* const out =
        c->add_subcommand("export", "Write one CSV row per frame: poses, cameras, changes, times.");
    out->add_option("FILE", o->file, "recording made by --record")->required();
    out->add_option("--csv", o->csv, "CSV file to write; its first lines explain the columns")->required();
    out->footer(R"(Prepared by (view needs a display):
  lightwell view atrium --record walk.lwr
Examples:
  lightwell recording export walk.lwr --csv walk.csv)");
    out->callback([o, &exit_code] { exit_code = run_export(*o); });
    c->footer(R"(Prepared by (view needs a display):
  lightwell view atrium --record walk.lwr
Examples:
  lightwell recording info walk.lwr
  lightwell recording export walk.lwr --csv walk.csv)");
}

} // namespace viewer
