#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/examples.h"
#include "viewer/displays/import.h"
#include "viewer/displays/test_pattern.h"
#include "viewer/displays/view_summary.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct DisplayOptions {
    std::string file, out, out_folder, pattern = "grid", section, base, example;
    bool json = false;
};

nlohmann::ordered_json display_json(Display const& d, std::vector<ViewSummary> const& views)
{
    nlohmann::ordered_json j;
    j["name"] = d.name;
    if (d.world)
        j["world"] = {{"position_m", {d.world->position_m.x, d.world->position_m.y, d.world->position_m.z}},
                      {"yaw_deg", d.world->yaw_deg}};
    for (ViewSummary const& v : views)
        j["views"].push_back({{"name", v.view.name},
                              {"wall", d.walls[std::size_t(v.view.wall)].name},
                              {"width_m", v.width_m},
                              {"height_m", v.height_m},
                              {"width_px", v.view.width_px},
                              {"height_px", v.view.height_px},
                              {"stereo", name_of(d.walls[std::size_t(v.view.wall)].stereo)},
                              {"eye", name_of(v.view.eye)},
                              {"rank", d.walls[std::size_t(v.view.wall)].rank},
                              {"eye_is", name_of(v.view.place)},
                              {"distance_m", v.distance_m},
                              {"horizontal_fov_deg", v.horizontal_deg},
                              {"vertical_fov_deg", v.vertical_deg},
                              {"px_per_deg_across", v.px_per_deg_across},
                              {"px_per_deg_upward", v.px_per_deg_upward}});
    return j;
}

void print_parts(Display const& d)
{
    if (d.world)
        fmt::print(
            "world: the room's origin is at ({:.4g}, {:.4g}, {:.4g}) m of the scene, turned by {:.4g} degrees\n",
            d.world->position_m.x, d.world->position_m.y, d.world->position_m.z, d.world->yaw_deg);
    for (DisplayWindow const& w : d.windows)
        fmt::print("window {}: {} x {} px at ({}, {}){}{}\n", w.name, w.width_px, w.height_px, w.x_px, w.y_px,
                   w.monitor >= 0 ? fmt::format(" of monitor {}", w.monitor) : "",
                   std::string(w.fullscreen ? ", full screen"
                               : w.borders  ? ""
                                            : ", without borders") +
                       (w.swap_group > 0
                            ? fmt::format(", swap group {}{} (needs GLX_NV_swap_group)", w.swap_group,
                                          w.swap_barrier > 0 ? fmt::format(" at barrier {}", w.swap_barrier) : "")
                            : ""));
    for (User const& u : d.users)
        fmt::print("user {}: eyes {:.4g} m apart, head at ({:.4g}, {:.4g}, {:.4g}) m{}\n", u.name,
                   u.interpupillary_m, u.head.translation_m.x, u.head.translation_m.y, u.head.translation_m.z,
                   u.tracker >= 0 ? ", tracked by " + d.trackers[std::size_t(u.tracker)].name : "");
    for (DisplayTracker const& t : d.trackers)
        fmt::print("tracker {}: {}{}{}, latency {:.4g} ms\n", t.name, name_of(t.type),
                   t.port > 0 ? fmt::format(" at {}:{}", t.address, t.port) : "",
                   t.body.empty() ? "" : ", body " + t.body, t.latency_ms);
}

int run_check(DisplayOptions const& o)
{
    gi::Report report;
    Display const d = load_display(o.file, report);
    std::vector<ViewSummary> const views = summarise_views(d);
    for (ViewSummary const& v : views)
        if (!v.view.camera)
            report.lose("eyes that cannot see their wall from the rest position: it stays dark", 1,
                        fmt::format("{}: the eye is {} the wall", v.view.name, name_of(v.view.place)));
    if (o.json) {
        nlohmann::ordered_json j = display_json(d, views);
        j["report"] = to_json(report);
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    fmt::print("{}{}\n", o.file, d.name.empty() ? "" : ": " + d.name);
    fmt::print("{:<28}{:>18}{:>14}  {:<18}{:>5}{:>10}{:>16}{:>14}\n", "view", "wall, m", "picture, px", "stereo",
               "rank", "eye at, m", "angle, degrees", "px/degree");
    for (ViewSummary const& v : views) {
        Wall const& wall = d.walls[std::size_t(v.view.wall)];
        fmt::print("{:<28}{:>18}{:>14}  {:<18}{:>5}{:>10}{:>16}{:>14}\n", v.view.name,
                   wall.surface ? name_of(wall.surface->type)
                                : fmt::format("{:.4g} x {:.4g}", v.width_m, v.height_m),
                   fmt::format("{} x {}", v.view.width_px, v.view.height_px),
                   wall.eye == Eye::middle ? name_of(wall.stereo) : std::string(name_of(wall.eye)) + " eye",
                   wall.rank, fmt::format("{:.3f}", v.distance_m),
                   v.view.camera ? fmt::format("{:.1f} x {:.1f}", v.horizontal_deg, v.vertical_deg) : "dark",
                   v.view.camera ? fmt::format("{:.1f} x {:.1f}", v.px_per_deg_across, v.px_per_deg_upward) : "");
    }
    print_parts(d);
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

/// YAML comments with all that the display file does not say.
std::string skipped_comment(std::string const& file, std::vector<SkippedPart> const& parts)
{
    auto const plain = [](std::string text) {
        for (char& c : text)
            if (static_cast<unsigned char>(c) < ' ') c = ' ';
        return text;
    };
    std::string text = "# From " + plain(file) + ", a configuration of " + name_of(format_of(file)) + ".\n";
    if (!parts.empty()) text += "# Not imported, or assumed:\n";
    for (SkippedPart const& part : parts) text += "# - " + plain(part.where) + ": " + plain(part.what) + "\n";
    return text;
}

/// Maps and pictures beside the display file. Throws InputError if they cannot be written.
void write_kept(std::vector<KeptFile> const& files, std::filesystem::path const& folder)
{
    for (KeptFile const& file : files) {
        std::filesystem::path const path = folder / file.name;
        std::error_code failure;
        std::filesystem::create_directories(path.parent_path(), failure);
        if (failure)
            throw gi::InputError("the folder " + path.parent_path().string() + " cannot be made",
                                 failure.message(), "name another --out");
        gi::write_text(path, {reinterpret_cast<char const*>(file.bytes.data()), file.bytes.size()});
    }
}

int run_import(DisplayOptions const& o)
{
    check_outputs({o.out}, {o.file});
    gi::Report report;
    std::filesystem::path const out(o.out), folder = out.parent_path();
    ImportLog const log(report, out.stem().string() + "_files/");
    Display const d = import_display(o.file, {o.section, o.base}, log);
    std::vector<SkippedPart> const& skipped = log.parts();
    write_kept(log.files(), folder);
    gi::write_text(o.out, skipped_comment(o.file, skipped) + to_yaml(d));
    if (o.json) {
        nlohmann::ordered_json j{{"out", o.out},
                                 {"program", name_of(format_of(o.file))},
                                 {"walls", d.walls.size()},
                                 {"windows", d.windows.size()},
                                 {"users", d.users.size()},
                                 {"files", log.files().size()},
                                 {"not_imported", nlohmann::ordered_json::array()}};
        for (SkippedPart const& part : skipped)
            j["not_imported"].push_back({{"what", part.what}, {"where", part.where}});
        j["report"] = to_json(report);
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    fmt::print("{}: {} walls, {} windows, {} users{}, from a configuration of {}\n", o.out, d.walls.size(),
               d.windows.size(), d.users.size(),
               log.files().empty() ? "" : fmt::format(", {} maps and pictures", log.files().size()),
               name_of(format_of(o.file)));
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

/// "03_left_wall_right_eye.png"
std::string picture_name(std::size_t index, std::string const& view)
{
    std::string name = fmt::format("{:02}_", index);
    for (char const c : view.substr(0, 80)) {
        bool const is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (is_plain || name.back() != '_') name += is_plain ? c : '_';
    }
    return name + ".png";
}

int run_calibrate(DisplayOptions const& o)
{
    auto const pattern = test_pattern(o.pattern);
    if (!pattern) {
        std::string known;
        for (TestPattern const p : kTestPatterns) known += (known.empty() ? "" : ", ") + std::string(name_of(p));
        throw gi::InputError("'" + o.pattern + "' is no pattern", "no pattern has this name",
                             "there are: " + known);
    }
    gi::Report report;
    Display const d = load_display(o.file, report);
    std::error_code failure;
    std::filesystem::create_directories(o.out_folder, failure);
    if (failure)
        throw gi::InputError("the folder " + o.out_folder + " cannot be made", failure.message(), "name another");
    auto const views = views_of(d, {});
    for (std::size_t i = 0; i < views.size(); ++i) {
        Wall const& wall = d.walls[std::size_t(views[i].wall)];
        bool const is_next_face = i > 0 && wall.surface && views[i - 1].wall == views[i].wall;
        if (is_next_face) continue; // one picture for the whole surface
        if (wall.surface && *pattern != TestPattern::grid) {
            report.lose("projections that are not flat, which have only the pattern grid", 1, wall.name);
            continue;
        }
        PatternPicture const picture =
            wall.surface ? draw_curved_grid(d, wall) : draw_pattern(*pattern, d, views[i]);
        auto const file =
            std::filesystem::path(o.out_folder) / picture_name(i, wall.surface ? wall.name : views[i].name);
        gi::write_png(file, picture.width, picture.height, picture.rgb);
        fmt::print("{}\n", file.string());
    }
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

int run_example(DisplayOptions const& o)
{
    std::string known;
    for (DisplayExample const& example : display_examples()) {
        known += (known.empty() ? "" : ", ") + std::string(example.name);
        if (o.example != example.name) continue;
        check_outputs({o.out}, {});
        gi::write_text(o.out, example.text);
        fmt::print("{}\n", o.out);
        std::fflush(stdout);
        return 0;
    }
    throw gi::InputError("there is no example '" + o.example + "'", "no built-in display has this name",
                         "there are: " + known);
}

} // namespace

void add_display(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<DisplayOptions>();
    CLI::App* const display = app.add_subcommand("display", about("display"));
    display->require_subcommand(1);

    CLI::App* const check =
        display->add_subcommand("check", "Print what a display file describes, as seen from the resting head.");
    check->add_option("FILE", o->file, "display file (YAML)")->required();
    check->add_flag("--json", o->json, "print JSON");
    check->callback([o, &exit_code] { exit_code = run_check(*o); });

    CLI::App* const import =
        display->add_subcommand("import", "Convert the configuration of another program to a display file.");
    import
        ->add_option("FILE", o->file,
                     ".json or .xml (SGCT), .pvx (ParaView), .eqc (Equalizer), .cfg (Vrui or\n"
                     "nDisplay's text), .ndisplay, .mpcdi, mpcdi.xml or .vwf")
        ->required();
    import->add_option("-o,--out", o->out, "display file to write; maps and pictures go to a folder beside it")
        ->required();
    import->add_flag("--json", o->json, "print JSON, with all that was not imported or assumed");
    import->add_option("--section", o->section, "Vrui only: name of the environment, usually that of a machine");
    import->add_option("--base", o->base, "Vrui only: configuration that FILE changes, usually its Vrui.cfg");
    import->callback([o, &exit_code] { exit_code = run_import(*o);
});

CLI::App* const calibrate =
    display->add_subcommand("calibrate", "Draw one PNG per wall and eye, to be shown full screen.");
calibrate->add_option("FILE", o->file, "display file (YAML)")->required();
calibrate->add_option("--pattern", o->pattern, "grid, corners, eyes, colours, crosstalk or blend")
    ->capture_default_str();
calibrate->add_option("-o,--out,--out-dir", o->out_folder, "folder for the PNG files")->required();
calibrate->callback([o, &exit_code] { exit_code = run_calibrate(*o); });

CLI::App* const example = display->add_subcommand("example", "Write one of the built-in example displays.");
example
    ->add_option("NAME", o->example,
                 "desktop3d.yaml, powerwall.yaml, cave4.yaml, cave5.yaml, dome.yaml,\n"
                 "planetarium.yaml,\n"
                 "cave.json, cave.pvx, cave.eqc, cave.cfg or cave.ndisplay")
    ->required();
example->add_option("-o,--out", o->out, "file to write")->required();
example->callback([o, &exit_code] { exit_code = run_example(*o); });

display->footer(R"(Examples:
  lightwell display example cave4.yaml --out cave4.yaml
  lightwell display check cave4.yaml
  lightwell display calibrate cave4.yaml --pattern grid --out patterns
  lightwell display example cave.pvx --out cave.pvx
  lightwell display import cave.pvx --out imported.yaml

Angles and pixels per degree are for one eye at the resting head, pixels per degree in the middle of the wall.
docs/displays.md describes the files.)");
} // namespace viewer

} // namespace viewer
