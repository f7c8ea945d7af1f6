#include "study/gaze/gaze_tables.h"

#include "gi/core/gzip.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace study {
namespace {

using Json = nlohmann::ordered_json;

std::string derivative_text(Json const& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json settings_json(GazeEventSettings const& s)
{
    Json j{{"Method", s.method == GazeMethod::ivt ? "I-VT" : "I-DT"}};
    if (s.method == GazeMethod::ivt) {
        j["MergeTimeMs"] = s.merge_ms;
    } else {
        j["DispersionDeg"] = s.dispersion_deg;
    }
    j["VelocityDegPerS"] = s.velocity_deg_s;
    j["VelocityWindowMs"] = s.window_ms;
    j["MinimumFixationMs"] = s.shortest_ms();
    j["MergeAngleDeg"] = s.merge_deg;
    j["BridgedGapMs"] = s.bridge_ms;
    return j;
}

Json described(char const* what, char const* unit = nullptr)
{
    Json j{{"Description", what}};
    if (unit) j["Units"] = unit;
    return j;
}

std::string rows_of(AnalysedGaze const& a)
{
    struct Row {
        double start_s;
        std::string text;
    };
    std::vector<Row> rows;
    double const left = 0.5 * a.recording.screen.width_px, top = 0.5 * a.recording.screen.height_px;
    for (Fixation const& f : a.events.fixations)
        rows.push_back(
            {f.start_s, fmt::format("{:.6f}\t{:.6f}\tfixation\t{:.2f}\t{:.2f}\tn/a\tn/a\t{}\n", f.start_s,
                                    f.end_s - f.start_s, f.x_px + left, f.y_px + top, int(f.is_cut))});
    for (Saccade const& s : a.events.saccades)
        rows.push_back({s.start_s, fmt::format("{:.6f}\t{:.6f}\tsaccade\t{:.2f}\t{:.2f}\t{:.4f}\t{:.2f}\t{}\n",
                                               s.start_s, s.end_s - s.start_s, s.to_x_px + left, s.to_y_px + top,
                                               s.amplitude_deg, s.peak_deg_s, int(s.is_cut))});
    for (GazeLoss const& l : a.events.losses)
        rows.push_back({l.start_s, fmt::format("{:.6f}\t{:.6f}\tloss\tn/a\tn/a\tn/a\tn/a\tn/a\n", l.start_s,
                                               l.end_s - l.start_s)});
    std::stable_sort(rows.begin(), rows.end(), [](Row const& a_, Row const& b) { return a_.start_s < b.start_s; });
    std::string text;
    for (Row const& r : rows) text += r.text;
    return text;
}

/// sub-P001/ses-01/beh/sub-P001_ses-01_task-session_recording-eye1, or the names of a BIDS file.
std::string stem_of(GazeRecording const& r)
{
    if (r.session > 0)
        return fmt::format("sub-{0}/ses-{1:02}/beh/sub-{0}_ses-{1:02}_task-session_recording-eye1", r.participant,
                           r.session);
    std::string folder = r.participant.empty() ? "" : "sub-" + r.participant + "/";
    if (auto const at = r.name.find("_ses-"); at != std::string::npos)
        folder += r.name.substr(at + 1, r.name.find('_', at + 1) - at - 1) + "/";
    return folder + "beh/" + (r.participant.empty() ? label_of(r.name) : r.name);
}

} // namespace

std::vector<TextFile> gaze_derivatives(GazeAnalysis const& analysis, std::string const& program_version)
{
    std::vector<TextFile> files{
        {"dataset_description.json",
         derivative_text({{"Name", "Fixations and saccades"},
                          {"BIDSVersion", "1.11.1"},
                          {"DatasetType", "derivative"},
                          {"GeneratedBy", {{{"Name", "Lightwell"}, {"Version", program_version}}}}})}};
    for (auto const& a : analysis.recordings) {
        std::string const stem = stem_of(a->recording) + "_desc-gaze_physioevents";
        std::string const rows = rows_of(*a);
        if (rows.empty()) continue;
        files.push_back({stem + ".tsv.gz", gi::gzip(rows)});
        Json j{{"Columns",
                {"onset", "duration", "trial_type", "x_coordinate", "y_coordinate", "amplitude", "peak_velocity",
                 "cut"}},
               {"onset", described("Beginning, on the clock of the samples", "s")},
               {"duration", described("Duration", "s")},
               {"trial_type",
                {{"Description", "What gaze did"},
                 {"Levels",
                  {{"fixation", "it stayed"}, {"saccade", "it jumped"}, {"loss", "there are no valid samples"}}}}},
               {"x_coordinate", described("Mean place of a fixation, end of a saccade; from the left", "pixel")},
               {"y_coordinate", described("The same from the top, down", "pixel")},
               {"amplitude", described("Angle between gaze before and after a saccade", "deg")},
               {"peak_velocity", described("Greatest velocity of a saccade", "deg/s")},
               {"cut", described("1: samples are lost at its beginning or end")},
               {"DetectionSettings", settings_json(analysis.settings.events)}};
        files.push_back({stem + ".json", derivative_text(j)});
    }
    return files;
}

} // namespace study
