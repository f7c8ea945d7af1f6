#include "study/gaze/gaze_recording.h"

#include "gi/core/text.h"
#include "study/gaze/session_gaze.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

/// None: its size or distance is not recorded.
std::optional<ScreenGeometry> recorded_screen(SessionStarted const& start)
{
    ScreenGeometry s;
    s.method = "recorded";
    if (auto const per_tangent = gi::parse_finite(recorded_fact(start, "gaze_px_per_tangent"));
        per_tangent && *per_tangent > 0) {
        auto const px = recorded_pair(start, "window_px");
        if (!px) return {};
        s.width_px = int(px->first);
        s.height_px = int(px->second);
        s.width_cm = s.width_px; // one pixel counts as a centimetre: only angles matter
        s.height_cm = s.height_px;
        s.distance_cm = *per_tangent;
        return s;
    }
    auto const px = recorded_pair(start, "screen_px"), cm = recorded_pair(start, "screen_cm");
    auto const distance = gi::parse_finite(recorded_fact(start, "viewing_distance_cm"));
    if (!px || !cm || !distance || !(*distance > 0)) return {};
    s.width_px = int(px->first);
    s.height_px = int(px->second);
    s.width_cm = cm->first;
    s.height_cm = cm->second;
    s.distance_cm = *distance;
    return s;
}

/// Stimuli that appear together are one view; what is shown again is another one.
void add_views(Script const& script, TrialRow const& row, std::vector<GazeView>& views)
{
    std::vector<StimulusShown> shown = row.done->shown;
    std::stable_sort(shown.begin(), shown.end(),
                     [](auto const& a, auto const& b) { return a.onset_s < b.onset_s; });
    for (std::size_t i = 0; i < shown.size();) {
        GazeView view;
        view.block = row.block->name;
        view.step = row.done->step;
        view.attempt = row.done->attempt;
        view.is_counted = row.status == TrialStatus::counted;
        view.start_s = shown[i].onset_s + row.offset_s;
        std::size_t next = i;
        for (; next < shown.size() && shown[next].onset_s == shown[i].onset_s; ++next) {
            view.shown += shown[next].letter;
            view.end_s = std::max(view.end_s, shown[next].onset_s + shown[next].duration_s + row.offset_s);
            Stimulus const* const stimulus = stimulus_of(row.step->trial, shown[next].letter);
            if (stimulus == nullptr) continue;
            std::string levels;
            for (std::size_t f = 0; f < script.factors.size(); ++f)
                levels += (f ? ", " : "") + script.factors[f].levels[std::size_t(stimulus->levels[f])].name;
            view.condition += (view.condition.empty() ? "" : " | ") + levels;
        }
        i = next;
        views.push_back(std::move(view));
    }
}

} // namespace

GazeRecordings gaze_of_records(std::filesystem::path const& dir, Dataset const& records,
                               std::optional<ScreenGeometry> const& screen,
                               std::vector<std::string> const& exclude)
{
    GazeRecordings all;
    int without = 0;
    for (RecordedSession const& session : records.sessions) {
        SessionStarted const& start = start_of(records.script, session);
        if (std::find(exclude.begin(), exclude.end(), start.participant_id) != exclude.end()) continue;
        SessionGaze raw = read_session_gaze(dir, records.script, session);
        all.remarks.insert(all.remarks.end(), raw.remarks.begin(), raw.remarks.end());
        all.inputs.insert(all.inputs.end(), raw.files.begin(), raw.files.end());
        if (raw.samples.empty()) {
            ++without;
            continue;
        }
        GazeRecording r;
        r.name = fmt::format("sub-{}_ses-{:02}", start.participant_id, start.session);
        r.participant = start.participant_id;
        r.session = start.session;
        r.source = recorded_fact(start, "gaze_source");
        r.eyes = "as recorded";
        auto const of_session = screen ? screen : recorded_screen(start);
        if (!of_session) {
            all.remarks.push_back(r.name +
                                  ": left out, as size and distance of the screen were not recorded; give "
                                  "--display-model");
            continue;
        }
        r.screen = *of_session;
        // Places are from the corner of the window, which is seen from in front of its centre.
        r.window_px = recorded_pair(start, "window_px")
                          .value_or(std::pair<double, double>(r.screen.width_px, r.screen.height_px));
        for (GazeSample& s : raw.samples) {
            s.x_px -= 0.5 * r.window_px.first;
            s.y_px -= 0.5 * r.window_px.second;
        }
        r.counts.samples = int(raw.samples.size());
        r.counts.unreadable = raw.unreadable;
        r.samples = clean_gaze(raw.samples, r.screen, r.counts);
        for (TrialRow const& row : trial_rows(records.script, session)) add_views(records.script, row, r.views);
        all.recordings.push_back(std::move(r));
    }
    if (without > 0) all.remarks.push_back(fmt::format("{} sessions have no samples of gaze", without));
    return all;
}

} // namespace study
