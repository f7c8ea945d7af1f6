#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"
#include "study/display/luminance_fit.h"
#include "study/display/model_file.h"
#include "viewer/base/arguments.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/displays/edid.h"
#include "viewer/experiment/calibrate/shown_steps.h"
#include "viewer/experiment/screens/monitor_check.h"
#include "viewer/experiment/screens/window_screen.h"
#include "viewer/report/machine.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct CalibrateOptions {
    std::string out, from, luminance, measure, gamma_by_eye, readings_out, size = "1280x720", screen, fullscreen;
    std::string by, instrument, room, date, monitor;
    std::vector<std::string> typed;
    std::optional<double> width_cm, height_cm, distance_cm, ipd_mm, white, black;
    std::vector<double> primaries, white_xy;
    int levels = 9;
    bool card = false;
};

using study::PatchColour;

PatchColour patch_colour(std::string_view word, std::string const& where)
{
    for (PatchColour const colour : study::kPatchColours)
        if (word == study::name_of(colour)) return colour;
    throw gi::InputError(fmt::format("{}: '{}' is no colour", where, word), "patches have one",
                         "write white, red, green or blue");
}

std::vector<PatchColour> colours_of(std::string const& list, std::string const& where)
{
    std::vector<PatchColour> colours;
    for (std::string_view const word : gi::split_at_commas(list)) colours.push_back(patch_colour(word, where));
    return colours;
}

/// "red:0.5=10.3" or "red:128=10.3"
study::LuminanceReading reading_of(std::string const& text)
{
    std::string_view rest = text;
    std::string_view const colour = gi::take_until(rest, ':'), value = gi::take_until(rest, '=');
    auto const v = gi::parse_finite(value), l = gi::parse_finite(rest);
    if (!v || !l || *v < 0 || *v > 255 || *l < 0)
        throw gi::InputError(fmt::format("--reading {}", text), "a reading is a colour, a value and a luminance",
                             "write white:1=80.3 (or white:255=80.3), in cd/m2");
    return {patch_colour(colour, "--reading"), *v > 1 ? *v / 255 : *v, *l};
}

std::optional<study::DisplayColour> colour_of_options(CalibrateOptions const& o)
{
    if (o.primaries.empty() && o.white_xy.empty()) return {};
    if (o.primaries.size() != 6 || o.white_xy.size() != 2)
        throw gi::InputError("--primaries and --white-xy",
                             "the colour of a display is known with six numbers and two",
                             "write --primaries 0.64,0.33,0.30,0.60,0.15,0.06 --white-xy 0.3127,0.3290");
    auto const& p = o.primaries;
    study::DisplayColour const c{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {o.white_xy[0], o.white_xy[1]}};
    study::luminance_shares(c); // checks them
    return c;
}

void take_monitor(study::DisplayModel& model, MonitorInfo const& monitor,
                  std::optional<MonitorIdentity> const& edid)
{
    model.connector = monitor.name;
    model.refresh_hz = monitor.refresh_hz;
    if (edid) model.monitor = to_text(*edid);
    study::ScreenGeometry screen = model.screen.value_or(study::ScreenGeometry{});
    screen.width_px = monitor.size_px.x;
    screen.height_px = monitor.size_px.y;
    model.screen = screen;
}

/// Refuses sizes that will not do, before anything is measured.
void check_size(CalibrateOptions const& o, study::DisplayModel const& model)
{
    if (!o.screen.empty()) parse_size(o.screen);
    bool const has_size = o.card || o.width_cm || o.height_cm || (model.screen && model.screen->width_cm > 0);
    if (o.distance_cm && !has_size)
        throw gi::InputError("--distance-cm without the size of the screen", "degrees need both",
                             "add --width-cm, or --card to measure it");
}

/// Sizes that were typed or matched. @param px_per_cm  by the card
void take_size(study::DisplayModel& model, CalibrateOptions const& o, std::optional<double> px_per_cm)
{
    study::ScreenGeometry s = model.screen.value_or(study::ScreenGeometry{});
    if (!o.screen.empty()) std::tie(s.width_px, s.height_px) = parse_size(o.screen);
    if (px_per_cm) {
        s.width_cm = s.width_px / *px_per_cm;
        s.height_cm = s.height_px / *px_per_cm;
        s.method = "card";
    }
    if (o.width_cm || o.height_cm) {
        if (s.width_px == 0)
            throw gi::InputError("--width-cm without a screen in pixels", "pixels per centimetre need both",
                                 "add --screen 1920x1080, or run it where the display is");
        s.width_cm = o.width_cm ? *o.width_cm : *o.height_cm * s.width_px / s.height_px;
        s.height_cm = o.height_cm ? *o.height_cm : *o.width_cm * s.height_px / s.width_px;
        s.method = "typed";
    }
    if (o.distance_cm) s.distance_cm = *o.distance_cm;
    model.screen.reset();
    if (s.width_px > 0 && s.width_cm > 0) model.screen = s;
    if (o.distance_cm && !model.screen)
        throw gi::InputError("--distance-cm without the size of the screen", "degrees need both",
                             "add --width-cm, or --card to measure it");
}

void check_date(std::string const& date)
{
    int year = 0, month = 0, day = 0, read = 0;
    bool const is_shaped = std::sscanf(date.c_str(), "%4d-%2d-%2d%n", &year, &month, &day, &read) == 3 &&
                           std::size_t(read) == date.size() && date.size() == 10;
    if (!is_shaped || !std::chrono::year_month_day(std::chrono::year(year), std::chrono::month(unsigned(month)),
                                                   std::chrono::day(unsigned(day)))
                           .ok())
        throw gi::InputError("--date " + date, "there is no such day", "write 2026-11-26");
}

int run_calibrate(CalibrateOptions const& o)
{
    if (!o.date.empty()) check_date(o.date);
    check_outputs({o.out, o.readings_out}, {o.from, o.luminance});
    study::DisplayModel model;
    if (!o.from.empty()) model = study::load_display_model(o.from);
    auto const measured_colours =
        o.measure.empty() ? std::vector<PatchColour>{} : colours_of(o.measure, "--measure");
    auto const matched_colours =
        o.gamma_by_eye.empty() ? std::vector<PatchColour>{} : colours_of(o.gamma_by_eye, "--gamma-by-eye");
    std::vector<study::LuminanceReading> readings;
    if (!o.luminance.empty()) readings = study::read_readings(gi::read_text(o.luminance), o.luminance);
    for (std::string const& text : o.typed) readings.push_back(reading_of(text));
    if (!matched_colours.empty() && (!readings.empty() || !measured_colours.empty()))
        throw gi::InputError("a photometer and --gamma-by-eye", "the photometer is better",
                             "leave out --gamma-by-eye");
    if (auto const colour = colour_of_options(o)) model.colour = colour;
    model.date = o.date.empty() ? this_moment().substr(0, 10) : o.date;
    for (auto const& [given, to] :
         {std::pair{&o.by, &model.by}, {&o.instrument, &model.instrument}, {&o.room, &model.room}})
        if (!given->empty()) *to = *given;
    if (o.ipd_mm) model.ipd_mm = o.ipd_mm;

    check_size(o, model);
    auto const keep_readings = [&] {
        if (!o.readings_out.empty() && !readings.empty())
            gi::write_text(o.readings_out, study::readings_text(readings));
    };

    gi::Report report;
    std::vector<study::GammaMatch> matches;
    std::optional<double> px_per_cm;
    if (!measured_colours.empty() || !matched_colours.empty() || o.card) {
        ScreenSettings settings;
        std::tie(settings.window.size_px.x, settings.window.size_px.y) = parse_size(o.size);
        settings.window.title = "Lightwell: calibrate";
        settings.window.monitor = o.fullscreen;
        WindowScreen screen(settings, report);
        if (auto const monitor = monitor_of(screen.window()))
            take_monitor(model, *monitor, monitor_at(monitor->name));
        if (o.card) px_per_cm = match_card(screen);
        // Kept one by one: typing them takes long, and what follows may be refused or ended.
        std::vector<study::LuminanceReading> const before = readings;
        measure_patches(screen, measured_colours, study::series_values(o.levels),
                        [&](std::vector<study::LuminanceReading> const& so_far) {
                            readings = before;
                            readings.insert(readings.end(), so_far.begin(), so_far.end());
                            keep_readings();
                        });
        matches = match_patterns(screen, matched_colours, {0.25, 0.5, 0.75});
    }
    if (!o.monitor.empty()) model.monitor = o.monitor;
    take_size(model, o, px_per_cm);
    keep_readings();
    std::vector<std::string> warnings;
    if (!readings.empty() || !matches.empty()) {
        study::LuminanceFit fit = readings.empty() ? study::fit_matches(matches, o.white, o.black, model.colour)
                                                   : study::fit_luminance(readings, model.colour);
        model.luminance = std::move(fit.light);
        warnings = std::move(fit.warnings);
    }
    if (!model.screen && !model.luminance)
        throw gi::InputError("nothing was measured", "a display model has a size or a luminance",
                             "give --luminance FILE, --reading, --measure, --gamma-by-eye, --card or --width-cm");
    std::string const text = study::display_model_text(model);
    study::parse_display_model(text, o.out); // what is written can be read
    gi::write_text(o.out, text);
    fmt::print("{}{}\n", study::display_model_summary(model), o.out);
    std::fflush(stdout);
    for (std::string const& w : warnings) std::fputs(("doubt: " + w + "\n").c_str(), stderr);
    print_losses(report);
    return 0;
}

} // namespace

void add_study_calibrate(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<CalibrateOptions>();
    CLI::App* const c = study.add_subcommand("calibrate", about("study calibrate"));
    c->add_option("-o,--out", o->out, "display model to write (YAML, docs/displays.md)")->required();
    c->add_option("--from", o->from, "display model to begin with; what is not measured now is kept");
    c->add_option("--luminance", o->luminance,
                  "photometer's readings (CSV: channel,value,cd_m2; values 0..1 or 0..255)");
    c->add_option("--reading", o->typed, "one reading, typed: white:255=80.3; may be repeated");
    c->add_option("--measure", o->measure,
                  "show patches of these colours, whose luminances are typed: white,red,green,blue");
    c->add_option("--levels", o->levels, "values of each colour with --measure")
        ->check(CLI::Range(3, 256))
        ->capture_default_str();
    c->add_option("--readings-out", o->readings_out, "file for all readings (CSV)");
    c->add_option("--gamma-by-eye", o->gamma_by_eye,
                  "gamma by matching lines with an area, of these colours: white, or red,green,blue");
    c->add_option("--white", o->white, "with --gamma-by-eye: luminance of white, cd/m2")
        ->check(CLI::Range(1e-3, 1e5));
    c->add_option("--black", o->black, "with --gamma-by-eye: luminance of black, cd/m2")
        ->check(CLI::Range(0.0, 1e4));
    c->add_flag("--card", o->card, "measure the screen by a bank card held on it");
    c->add_option("--width-cm", o->width_cm, "width of the picture")->check(CLI::Range(0.1, 10000.0));
    c->add_option("--height-cm", o->height_cm, "height of the picture (default: by the width and square pixels)")
        ->check(CLI::Range(0.1, 10000.0));
    c->add_option("--distance-cm", o->distance_cm, "from the eyes to the middle of the screen")
        ->check(CLI::Range(1.0, 100000.0));
    c->add_option("--ipd-mm", o->ipd_mm, "distance of the pupils")->check(CLI::Range(40.0, 80.0));
    c->add_option("--primaries", o->primaries, "CIE 1931 x,y of red, green, blue: six numbers")->delimiter(',');
    c->add_option("--white-xy", o->white_xy, "CIE 1931 x,y of white")->delimiter(',');
    c->add_option("--screen", o->screen, "pixels of the monitor's mode: 1920x1080 (default: as the window finds)");
    c->add_option("--monitor", o->monitor, "name of the monitor (default: by EDID)");
    c->add_option("--instrument", o->instrument, "photometer");
    c->add_option("--by", o->by, "who measured");
    c->add_option("--room", o->room, "light of the room");
    c->add_option("--date", o->date, "2026-11-26 (default: today)");
    c->add_option("--size", o->size, "window size, px")->capture_default_str();
    c->add_option("--fullscreen", o->fullscreen, "full screen on the monitor with this number or name");
    c->callback([o, &exit_code] { exit_code = run_calibrate(*o); });
    c->footer(R"(Examples:
  lightwell study calibrate --luminance readings.csv --screen 1920x1080 --width-cm 53.1 --distance-cm 57 --out monitor.yaml
  lightwell study calibrate --fullscreen 0 --card --measure white,red,green,blue --distance-cm 57 --out monitor.yaml
  lightwell study calibrate --fullscreen 0 --gamma-by-eye white --white 120 --from monitor.yaml --out eye.yaml

In the window: up, down, page up, page down change a value, enter takes it, backspace goes back, escape ends.)");
}

} // namespace viewer
