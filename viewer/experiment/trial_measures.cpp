// Measurements of a trial: its stimuli and the participant's gaze, and the messages about them to other programs.

#include "viewer/engine/picture_margin.h"
#include "viewer/experiment/page.h"
#include "viewer/experiment/stimuli/physical.h"
#include "viewer/experiment/trial.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {

/// Sets how the stimulus is shown on a calibrated display, and measures its newest picture.
void TrialPresenter::Trial::calibrate_light(LoadedStimulus& k, bool counts)
{
    if (!p_.table_light_) return;
    auto const frame = k.source->newest();
    gi::Picture const shown =
        frame && !frame->result.views.empty()
            ? without_margin(frame->result.views[0].picture, frame->result.views[0].margin_px)
            : gi::Picture{};
    gi::Layer const* const color = shown.find("color");
    gi::ToneMapSettings const tone = frame ? tone_settings(frame->settings) : gi::ToneMapSettings{};
    study::DisplayLuminance const& display = *p_.model()->luminance;
    k.light = light_of(k.settings.physical, display, p_.table_light_, color, tone);
    if (color == nullptr) return;
    k.shown_light = shown_light(*color, tone, k.light, display);
    if (std::size_t const clipped = k.shown_light->bright + k.shown_light->dark; clipped > 0 && counts)
        p_.report_.lose("pixels that were brighter or darker than the display can be", clipped,
                        fmt::format("stimulus {} of trial {}", k.letter, request_.step_index + 1));
}

/// Waits for the fixation that the block demands. Returns false if it does not come, or the trial is over.
bool TrialPresenter::Trial::await_fixation()
{
    if (!block_.gaze.start) return true;
    study::GazeFixation const& rule = *block_.gaze.start;
    study::GazeWatch watch(p_.gaze_screen(), {0, 0}, rule.within_deg);
    p_.gaze_.watch(&watch);
    ScreenContent empty = content("");
    empty.text = [](glm::vec2 px) { draw_cross(px); };
    p_.present(empty);
    double const until_s = p_.now() + 1e-3 * rule.timeout_ms;
    while (watch.inside_ms() < rule.for_ms && p_.now() < until_s && !p_.should_end()) {
        p_.screen_->wait_until(Clock::now() + std::chrono::milliseconds(2));
        p_.between_frames();
        heed(p_.screen_->take_input());
    }
    p_.gaze_.watch(nullptr);
    if (watch.inside_ms() < rule.for_ms) gaze_failure_ = "no_fixation";
    return gaze_failure_.empty() && !p_.should_end();
}

/// Counts the samples that came while stimuli were visible.
void TrialPresenter::Trial::keep_gaze()
{
    if (!p_.gaze_.is_open()) return;
    int samples = 0, valid = 0, dropped = 0;
    for (auto const& shown : gaze_seen_) { // what was between them is not missing
        study::GazeSummary const sum = study::summarise(shown);
        samples += sum.samples;
        valid += sum.valid;
        dropped += sum.dropped;
    }
    done_.gaze_samples = samples;
    done_.gaze_valid = valid;
    done_.gaze_dropped = dropped;
    study::GazeRules const& rules = block_.gaze;
    if (!rules.hold && !rules.start) return;
    study::GazeWatch watch(p_.gaze_screen(), {0, 0},
                           rules.hold ? rules.hold->within_deg : rules.start->within_deg);
    for (auto const& shown : gaze_seen_)
        for (study::GazeSample const& s : shown) watch.take(s);
    done_.gaze_fixating = watch.inside();
}

void TrialPresenter::Trial::start_cues(study::CueMoment moment, std::string const& at)
{
    bool const is_first = moment != study::CueMoment::fixation && done_.shown.empty();
    ScreenContent empty = content("");
    if (block_.is_sequential && moment != study::CueMoment::fixation)
        empty.text = [](glm::vec2 px) { draw_cross(px); };
    double due_s = p_.now();
    int frames = 0;
    if (cues_.plays_at(moment, is_first)) { // at a refresh that is far enough
        double const last_s = p_.seconds(p_.present(empty).time);
        frames = std::max(1, int(std::ceil(cues_.lead_s(moment, is_first) / p_.period_s_)));
        due_s = last_s + frames * p_.period_s_;
    }
    cues_.start(moment, is_first, at, due_s);
    for (; frames > 1 && !p_.should_end(); --frames) p_.present(empty);
}

void TrialPresenter::Trial::show_fixation()
{
    start_cues(study::CueMoment::fixation, "fixation");
    if (!cues_.plays_at(study::CueMoment::fixation)) return;
    ScreenContent empty = content("");
    if (block_.is_sequential || block_.gaze.start) empty.text = [](glm::vec2 px) { draw_cross(px); };
    cues_.came(p_.seconds(p_.present(empty).time));
}

/// A trial whose sound failed is not valid; one that ended before a sound was due is.
void TrialPresenter::Trial::keep_sounds()
{
    done_.sounds = cues_.take(p_.now());
    for (study::SoundPlayed const& s : done_.sounds) {
        if (s.onset_s)
            mark(*s.onset_s, "sound", {{"sound", s.sound}, {"at", s.at}, {"event_s", s.event_s}});
        else if (s.missing == "device failed" || s.missing == "too many sounds") {
            done_.is_valid = false;
            done_.reason = "no_sound";
        }
    }
}

/// Conditions of stimuli, by letter: {"a": "bounces=2"}.
nlohmann::ordered_json TrialPresenter::Trial::labels(std::string const& letters) const
{
    nlohmann::ordered_json all = nlohmann::ordered_json::object();
    for (LoadedStimulus const& k : known_)
        if (letters.find(k.letter) != std::string::npos)
            all[std::string(1, k.letter)] = stimulus_label(*request_.script, block_, k.stimulus);
    return all;
}

/// A marker with the place of this trial in the session.
void TrialPresenter::Trial::mark(double time_s, std::string const& what, nlohmann::ordered_json about)
{
    nlohmann::ordered_json all{{"step", request_.step_index},
                               {"attempt", request_.attempt},
                               {"trial", request_.step->number},
                               {"block", block_.name}};
    all.update(about);
    p_.markers_.send(time_s, what, std::move(all));
}

} // namespace viewer
