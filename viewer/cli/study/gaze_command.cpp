#include "viewer/cli/study/gaze_command.h"

#include "gi/core/error.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "study/analysis/result_tables.h"
#include "study/analysis/table_json.h"
#include "study/display/model_file.h"
#include "study/gaze/gaze_heat.h"
#include "study/gaze/gaze_tables.h"
#include "viewer/base/version.h"
#include "viewer/experiment/looked/looked_at.h"
#include "viewer/experiment/stimuli/study_scenes.h"
#include "viewer/study/study_records.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr int kHeatCells = 640;

study::GazeAnalysisSettings settings_of(GazeOptions const& o)
{
    study::GazeAnalysisSettings s = o.settings;
    s.events.method = o.method == "idt" ? study::GazeMethod::idt : study::GazeMethod::ivt;
    if (o.min_fixation_ms >= 0) s.events.min_fixation_ms = o.min_fixation_ms;
    return s;
}

std::optional<study::ScreenGeometry> given_screen(std::string const& file)
{
    if (file.empty()) return {};
    study::DisplayModel const model = study::load_display_model(file);
    if (!model.screen || !(model.screen->distance_cm > 0))
        throw gi::InputError("'" + file + "' has no screen with a distance", "degrees need it",
                             "measure it by study calibrate");
    return model.screen;
}

struct Analysed {
    study::GazeAnalysis gaze;
    std::optional<LookedAt> looked; ///< with --objects
};

Analysed analysed(GazeOptions const& o, GazeCall const& call)
{
    if (call.dir.empty() == o.files.empty())
        throw gi::InputError(o.files.empty() ? "--gaze without records" : "DIR and files of --gaze",
                             "gaze is either that of a folder of records or of files",
                             "give DIR before --gaze, or files behind it");
    auto const screen = given_screen(o.display_model);
    if (call.dir.empty()) {
        auto const eyes = o.eyes == "left"    ? study::GazeEyes::left
                          : o.eyes == "right" ? study::GazeEyes::right
                                              : study::GazeEyes::mean;
        if (!call.exclude.empty())
            throw gi::InputError("--exclude with files", "participants of records are excluded",
                                 "leave out their files");
        if (o.follows_rays)
            throw gi::InputError("--objects with files", "only records of sessions name scenes and cameras",
                                 "give DIR before --gaze");
        return {study::analyse_gaze(study::gaze_of_files({o.files.begin(), o.files.end()}, screen, eyes),
                                    settings_of(o)),
                {}};
    }
    if (o.eyes != "mean")
        throw gi::InputError("--eyes " + o.eyes + " with records", "sessions record one place for both eyes",
                             "leave it out");
    study::Dataset const records = load_records(call.dir, call.script);
    auto recordings = study::gaze_of_records(call.dir, records, screen, call.exclude);
    if (recordings.recordings.empty())
        throw gi::InputError(recordings.remarks.empty() ? "no session" : recordings.remarks.back(),
                             "there is no gaze to analyse",
                             "record it by study run --gaze with --display-model, or give other records");
    Analysed a{study::analyse_gaze(std::move(recordings), settings_of(o)), {}};
    if (!o.follows_rays) return a;
    LookedAtSettings settings;
    settings.accuracy_deg = o.accuracy_deg;
    a.looked = looked_at(records, a.gaze, study_scenes(), settings);
    a.gaze.cautions.insert(a.gaze.cautions.end(), a.looked->cautions.begin(), a.looked->cautions.end());
    return a;
}

/// Cells enlarged to a size, linearly.
study::HeatMap enlarged(study::HeatMap const& map, int width, int height)
{
    study::HeatMap to{width, height, {}, map.most, map.outside};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double const u = std::clamp((x + 0.5) * map.width / width - 0.5, 0.0, map.width - 1.0);
            double const v = std::clamp((y + 0.5) * map.height / height - 0.5, 0.0, map.height - 1.0);
            int const i = std::min(int(u), map.width - 2), j = std::min(int(v), map.height - 2);
            auto const at = [&](int a, int b) {
                return map
                    .density[std::size_t(std::max(0, b)) * std::size_t(map.width) + std::size_t(std::max(0, a))];
            };
            to.density.push_back(std::lerp(std::lerp(at(i, j), at(i + 1, j), u - i),
                                           std::lerp(at(i, j + 1), at(i + 1, j + 1), u - i), v - j));
        }
    return to;
}

/// @param picture  beneath the map; null = none
void write_heat(std::filesystem::path const& file, study::HeatMap const& map, gi::Picture const* picture)
{
    if (picture == nullptr) {
        gi::write_png(file, map.width, map.height, study::heat_colors(map, std::max(map.most, 1e-300)));
        return;
    }
    study::HeatMap const large = enlarged(map, picture->width, picture->height);
    auto bytes = study::heat_colors(large, std::max(large.most, 1e-300));
    gi::Layer const& color = gi::color_of(*picture, "--picture");
    std::vector<unsigned char> rgb;
    for (std::size_t i = 0; i < picture->pixels(); ++i) {
        gi::vec3 const under = gi::rgb(color, i);
        double const alpha = bytes[4 * i + 3] / 255.0;
        for (int c = 0; c < 3; ++c)
            rgb.push_back(static_cast<unsigned char>(
                std::lround(alpha * bytes[4 * i + std::size_t(c)] +
                            (1 - alpha) * 255 * gi::encode_srgb(std::clamp(under[c], 0.0f, 1.0f)))));
    }
    gi::write_png(file, picture->width, picture->height, rgb);
}

/// @param accuracy_deg  none: objects were not looked for
nlohmann::ordered_json to_json(study::GazeAnalysis const& a, std::optional<double> accuracy_deg,
                               std::vector<study::ResultTable> const& tables)
{
    using Json = nlohmann::ordered_json;
    study::GazeEventSettings const& e = a.settings.events;
    Json inputs = Json::array();
    for (study::InputFile const& f : a.inputs) inputs.push_back({{"file", f.file}, {"sha256", f.sha256}});
    Json j{{"version", version_number()},
           {"git", git_hash()},
           {"inputs", inputs},
           {"settings",
            {{"method", e.method == study::GazeMethod::ivt ? "ivt" : "idt"},
             {"velocity_deg_s", e.velocity_deg_s},
             {"window_ms", e.window_ms},
             {"dispersion_deg", e.dispersion_deg},
             {"min_fixation_ms", e.shortest_ms()},
             {"merge_ms", e.merge_ms},
             {"merge_deg", e.merge_deg},
             {"bridge_ms", e.bridge_ms},
             {"least_valid", a.settings.least_valid},
             {"accuracy_deg", accuracy_deg ? Json(*accuracy_deg) : Json()}}},
           {"cautions", a.cautions}};
    study::add_tables(j, tables);
    return j;
}

} // namespace

int run_gaze(GazeOptions o, GazeCall const& call)
{
    std::erase(o.files, ""); // CLI11 gives one for --gaze without values
    if (!o.picture.empty() && call.out.empty())
        throw gi::InputError("--picture without --out", "there is no heat map to lay on it", "give --out FOLDER");
    std::optional<gi::Picture> picture;
    if (!o.picture.empty()) picture = gi::read_picture(o.picture);
    auto const [analysis, looked] = analysed(o, call);
    auto tables = study::gaze_tables(analysis);
    auto const maps = study::condition_heat(analysis, o.heat_deg, kHeatCells);
    if (looked) tables.insert(tables.end(), looked->tables.begin(), looked->tables.end());
    if (!call.out.empty()) tables.push_back(study::heat_table(maps));
    std::string const json = to_json(analysis, looked ? std::optional(o.accuracy_deg) : std::nullopt, tables)
                                 .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                             "\n";
    if (!call.out.empty()) {
        std::vector<study::TextFile> files{{"gaze.json", json}};
        for (study::ResultTable const& t : tables)
            files.push_back({t.name + ".csv", study::csv_text(t.table, "NA")});
        write_files(call.out, files);
        for (study::ConditionHeat const& m : maps)
            write_heat(std::filesystem::path(call.out) / (m.file + ".png"), m.map, picture ? &*picture : nullptr);
        if (looked)
            for (SurfaceHeat const& h : looked->surfaces)
                write_heat_ply(std::filesystem::path(call.out) / (h.file + ".ply"), h);
    }
    if (!o.derivatives.empty()) write_files(o.derivatives, study::gaze_derivatives(analysis, version_number()));
    if (call.json) {
        std::fputs(json.c_str(), stdout);
        return 0;
    }
    for (std::string const& c : analysis.cautions) fmt::print("caution: {}\n", c);
    std::fputs(study::tables_text(tables).c_str(), stdout);
    return 0;
}

void add_gaze_options(CLI::App& command, GazeOptions& o)
{
    o.given =
        command
            .add_option("--gaze", o.files,
                        "analyse gaze instead of answers: that of DIR, or of FILES (BIDS eye tracking, both eyes "
                        "of a recording; tables t_s,x_px,y_px)")
            ->expected(0, -1)
            ->type_name("FILES");
    auto const number = [&](char const* name, double& value, char const* meaning, double low, double high) {
        command.add_option(name, value, meaning)
            ->check(CLI::Range(low, high))
            ->capture_default_str()
            ->needs(o.given);
    };
    study::GazeEventSettings& e = o.settings.events;
    command
        .add_option("--gaze-method", o.method,
                    "how fixations are found: ivt by velocity, idt by dispersion (Salvucci and Goldberg 2000)")
        ->check(CLI::IsMember({"ivt", "idt"}))
        ->capture_default_str()
        ->needs(o.given);
    number("--velocity", e.velocity_deg_s, "degrees per second: faster is a saccade", 1, 1000);
    number("--velocity-window", e.window_ms, "ms over which velocity is measured", 1, 200);
    number("--dispersion", e.dispersion_deg, "idt: degrees, width plus height of a fixation", 0.05, 20);
    command
        .add_option("--min-fixation", o.min_fixation_ms,
                    "ms: shorter fixations are left out (default: 60 with ivt, 100 with idt)")
        ->check(CLI::Range(0.0, 2000.0))
        ->needs(o.given);
    number("--merge-ms", e.merge_ms, "ivt: fixations that are nearer in time, ms, and direction are one", 0, 1000);
    number("--merge-deg", e.merge_deg, "that direction, degrees", 0, 10);
    number("--bridge", e.bridge_ms, "ms without valid samples that do not end what was going on", 0, 1000);
    number("--least-valid", o.settings.least_valid,
           "share of valid samples: with less, a view is marked and not in means", 0, 1);
    command.add_option("--eyes", o.eyes, "of files of two eyes: mean (where both are valid), left, right")
        ->check(CLI::IsMember({"mean", "left", "right"}))
        ->capture_default_str()
        ->needs(o.given);
    command
        .add_option(
            "--display-model", o.display_model,
            "with --gaze: pixels, size and distance of the screen, where records and files do not tell them")
        ->needs(o.given);
    number("--heat-deg", o.heat_deg, "heat maps of --out: standard deviation of the Gaussian, degrees", 0.05, 20);
    command.add_option("--picture", o.picture, "picture beneath the heat maps; it fills the screen")
        ->needs(o.given);
    CLI::Option* const objects =
        command
            .add_flag("--objects", o.follows_rays,
                      "also how long gaze was on each object and material of the scenes, by way of mirrors too; "
                      "with --out seconds per square metre of their surfaces (PLY)")
            ->needs(o.given);
    command
        .add_option("--accuracy", o.accuracy_deg,
                    "--objects: accuracy of the eye tracker, degrees (standard deviation of each axis)")
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str()
        ->needs(objects);
    command
        .add_option("--derivatives", o.derivatives,
                    "folder for fixations, saccades and losses as a derivative data set of BIDS")
        ->needs(o.given);
}

} // namespace viewer
