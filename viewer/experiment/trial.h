#pragma once
#include "viewer/experiment/response.h"
#include "viewer/experiment/trial_presenter.h"

namespace viewer {

/// Places side by side for so many pictures; below them there is room for text.
std::vector<ScreenPane> panes_for(std::size_t count, glm::ivec2 screen_px, float text_px);

/// How a stimulus is seen in a block that shows so many at a time.
StimulusView view_of(study::Block const& block, StimulusSettings const& stimulus, std::size_t together,
                     glm::ivec2 screen_px, float font_px);

/// A trial while it runs: gets ready, shows its stimuli, takes the answer.
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
    };

    bool get_ready(LoadedStimulus const& k);
    bool get_all_ready();
    bool wait_between(std::size_t next);
    bool heed(std::vector<InputEvent> const& events);
    bool wait(double until_s, bool cross);
    /// @param letters  that appear together   @param takes_answer  while they are seen
    void appear(std::string const& letters, bool takes_answer);
    void take_answers();
    void adjust();
    bool has_ended();
    void give_feedback();
    ScreenContent content(std::string const& letters);
    void add_rows(std::string const& letters, ScreenSwap const& swap, int dropped, ScreenContent const& content);
    study::Patch patch_of(std::size_t part, std::optional<double> level) const;

    TrialPresenter& p_;
    study::TrialRequest const& request_;
    study::Block const& block_;
    std::string order_; ///< letters in the order of presentation; r = the reference
    Response response_;
    study::TrialDone done_;
    std::vector<LoadedStimulus> known_; ///< each letter once
    bool is_answered_ = false, is_lost_ = false;
    double onset_s_ = 0, onset_uncertainty_ms_ = 0; ///< of the last stimulus
    double longest_look_ms_ = 0;
    std::optional<double> level_; ///< of an adjustment
};

} // namespace viewer
