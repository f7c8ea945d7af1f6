#include "study/gaze/gaze_analysis.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

ViewedGaze viewed(AnalysedGaze const& a, GazeView const& view, double least_valid)
{
    ViewedGaze v;
    v.view = &view;
    v.valid_share = valid_share(a.recording.samples, a.events.step_s, view.start_s, view.end_s);
    v.is_usable = v.valid_share >= least_valid;
    auto const within_s = [&](double start_s, double end_s) {
        return std::min(end_s, view.end_s) - std::max(start_s, view.start_s);
    };
    for (GazeLoss const& loss : a.events.losses)
        if (double const s = within_s(loss.start_s, loss.end_s); s > 0) {
            v.lost_s += s;
            ++v.losses;
        }
    for (Fixation const& f : a.events.fixations)
        if (double const s = within_s(f.start_s, f.end_s); s > 0)
            v.fixations.push_back({&f, int(v.fixations.size()) + 1, s});
    for (Saccade const& s : a.events.saccades) {
        if (s.start_s < view.start_s || s.start_s >= view.end_s) continue;
        if (v.saccades.empty()) v.first_saccade_ms = 1e3 * (s.start_s - view.start_s);
        v.saccades.push_back(&s);
        v.path_deg += s.amplitude_deg;
    }
    return v;
}

void add_doubts(AnalysedGaze const& a, std::vector<std::string>& cautions)
{
    GazeRecording const& r = a.recording;
    auto const say = [&](std::string const& what) { cautions.push_back(r.name + ": " + what); };
    if (!(a.events.step_s > 0)) {
        say("fewer than two samples with times that rise: nothing was found in it");
        return;
    }
    if (a.events.step_s > 1 / 50.0)
        say(fmt::format("{:.0f} samples a second: durations and velocities of saccades mean little",
                        1 / a.events.step_s));
    int const left_out = r.counts.unreadable + r.counts.no_time + r.counts.repeated + r.counts.backwards;
    if (left_out > 0)
        say(fmt::format(
            "{} of {} samples are left out: {} unreadable, {} without a time, {} with a time twice, {} "
            "where the clock jumped back",
            left_out, r.counts.samples, r.counts.unreadable, r.counts.no_time, r.counts.repeated,
            r.counts.backwards));
    int bad = 0, outside = 0;
    for (ViewedGaze const& v : a.views) {
        bad += !v.is_usable;
        outside += v.view->end_s <= r.samples.front().time_s || v.view->start_s >= r.samples.back().time_s;
    }
    if (bad > 0) say(fmt::format("{} of {} views have too few valid samples", bad, a.views.size()));
    if (outside > 0)
        say(fmt::format("{} of {} views are before or after all samples: are the clocks the same?", outside,
                        a.views.size()));
}

} // namespace

GazeAnalysis analyse_gaze(GazeRecordings recordings, GazeAnalysisSettings const& settings)
{
    GazeAnalysis analysis;
    analysis.settings = settings;
    analysis.inputs = std::move(recordings.inputs);
    analysis.cautions = std::move(recordings.remarks);
    for (GazeRecording& r : recordings.recordings) {
        auto a = std::make_unique<AnalysedGaze>();
        a->recording = std::move(r);
        auto const& samples = a->recording.samples;
        a->events = find_gaze_events(samples, a->recording.screen, settings.events);
        if (samples.size() > 1)
            a->valid_share = valid_share(samples, a->events.step_s, samples.front().time_s, samples.back().time_s);
        a->sequence = main_sequence(a->events.saccades);
        for (GazeView const& view : a->recording.views) a->views.push_back(viewed(*a, view, settings.least_valid));
        add_doubts(*a, analysis.cautions);
        analysis.recordings.push_back(std::move(a));
    }
    return analysis;
}

} // namespace study
