#pragma once
// One running trial of a TrialPresenter, and the layout of its pictures on the screen.

#include "viewer/experiment/response.h"
#include "viewer/experiment/trial_presenter.h"

namespace viewer {

/// Places for `count` pictures side by side, with room for text below.
std::vector<ScreenPane> panes_for(std::size_t count, glm::ivec2 screen_px, float text_px);

/// View of a stimulus in a block that shows `together` stimuli at a time.
/// @param model  for sizes in degrees; null = none
StimulusView view_of(study::Block const& block, StimulusSettings const& stimulus, std::size_t together,
                     glm::ivec2 screen_px, float font_px, study::DisplayModel const* model = nullptr);

/// A running trial: prepares and shows its stimuli and records the answer.
class TrialPresenter::Trial {
public:
    Trial(TrialPresenter& presenter, study::TrialRequest const& request);
    study::TrialDone run();

private:
    struct LoadedStimulus {
        char letter;
        study::Stimulus stimulus;
        StimulusSettings settings;
        StimulusSource* source;
        StereoMode stereo;
        DisplayLight light{};
        std::optional<ShownLight> shown_light{}; ///< of its first picture, on a calibrated display
    };

    /// Starts the cues of what comes next and shows empty frames until it is due.
    void start_cues(study::CueMoment moment, std::string const& at);
    void show_fixation();
    bool get_ready(LoadedStimulus& k);
    void draw_ahead(LoadedStimulus const& k);
    bool get_all_ready();
    void calibrate_light(LoadedStimulus& k, bool counts);
    bool await_fixation();
    void keep_gaze();
    void keep_sounds();
    nlohmann::ordered_json labels(std::string const& letters) const;
    void mark(double time_s, std::string const& what, nlohmann::ordered_json about);
    bool wait_between(std::size_t next);
    bool heed(std::vector<InputEvent> const& events);
    bool wait(double until_s, bool cross);
    /// @param letters  stimuli shown together   @param takes_answer  answers count while they are shown
    void appear(std::string const& letters, bool takes_answer);
    void take_answers();
    void adjust();
    bool has_ended();
    void give_feedback();
    ScreenContent content(std::string const& letters);
    /// The pane of a stimulus in a place on the screen.
    void fill(ScreenPane& pane, LoadedStimulus const& k) const;
    void add_rows(std::string const& letters, ScreenSwap const& swap, int dropped, ScreenContent const& content);
    study::Patch patch_of(std::size_t part, std::optional<double> level) const;

    TrialPresenter& p_;
    study::TrialRequest const& request_;
    study::Block const& block_;
    std::string order_; ///< letters in the order of presentation; r = the reference
    Response response_;
    CuePlayer cues_;
    study::TrialDone done_;
    std::vector<LoadedStimulus> known_; ///< each letter once
    bool is_answered_ = false, is_lost_ = false;
    std::string gaze_failure_;                              ///< no_fixation, gaze_left; empty = none
    std::vector<std::vector<study::GazeSample>> gaze_seen_; ///< while stimuli were visible, by onset
    double onset_s_ = 0, onset_uncertainty_ms_ = 0;         ///< of the last stimulus
    double longest_look_ms_ = 0;
    std::optional<double> level_; ///< current level of an adjustment
};

} // namespace viewer
