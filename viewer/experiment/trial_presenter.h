#pragma once
// Presents the steps of a session to a participant; implements study/run/presenter.h.

#include "study/run/presenter.h"
#include "viewer/devices/xr/session.h"
#include "viewer/experiment/answer_keys.h"
#include "viewer/experiment/experimenter.h"
#include "viewer/experiment/frame_table.h"
#include "viewer/experiment/gaze/gaze_recorder.h"
#include "viewer/experiment/markers.h"
#include "viewer/experiment/page.h"
#include "viewer/experiment/screens/screen_settings.h"
#include "viewer/experiment/sound/audio_output.h"
#include "viewer/experiment/sound/cue_player.h"
#include "viewer/experiment/stimuli/stimulus_source.h"

namespace viewer {

struct TrialOptions {
    ScreenSettings screen;
    StimulusViewer view = StimulusViewer::window; ///< default for stimuli, and for text at first
    HmdOptions headset;
    SceneAccess scenes;
    int threads = 0;              ///< 0 = all
    std::string participant;      ///< shown to the experimenter
    std::filesystem::path folder; ///< of the session, for the frame table
    std::string stem;             ///< "sub-P001_ses-01"
    RemoteOptions remote;
    gi::StopRequest const* stop = nullptr; ///< set by Ctrl-C; null = none
    int marker_port = kMarkerPort;
    int session = 1;  ///< its number
    std::string gaze; ///< as of open_gaze, instead of record.gaze of the script; empty = that of the script
    AudioOutput* audio = nullptr;   ///< null: cues are not heard
    SoundBank sounds;               ///< of the script
    std::filesystem::path prepared; ///< folder of pictures made ahead (study prepare)
    std::string version;            ///< of the program
    std::vector<std::pair<std::string, std::string>> about;
};

class TrialPresenter : public study::Presenter {
public:
    /// Opens the window. All arguments must outlive it. Throws InputError.
    TrialPresenter(study::Script const& script, TrialOptions const& options, gi::Report& report);
    ~TrialPresenter() override;

    glm::ivec2 screen_px() const { return screen_->size_px(); }

    double now() const override;
    std::vector<std::pair<std::string, std::string>> about() const override;
    study::CalibrationDone calibrate(study::Timing const& timing) override;
    bool ask_consent(std::string const& markdown) override;
    study::ParticipantAsked ask_participant(std::vector<study::AskedQuestion> const& questions) override;
    study::StepDone instruct(std::string const& markdown, int step) override;
    study::StepDone rest(std::string const& prompt, double least_s, int step) override;
    study::StepDone walk(study::TrialRequest const& where, std::string const& prompt, double seconds) override;
    study::QuestionnaireDone ask(study::QuestionnaireRequest const& request) override;
    study::TrialDone show(study::TrialRequest const& trial) override;
    study::ExperimenterAction action() override;
    std::vector<study::NoteTaken> notes() override;

private:
    /// None = the experimenter skipped it.
    std::optional<std::string> type_answer(study::AskedQuestion const& question);
    std::optional<std::string> choose_answer(study::AskedQuestion const& question);
    int type_item(study::Questionnaire const& q, std::size_t item, std::vector<PageLine> const& lines,
                  std::string& text);
    int choose_item(study::Questionnaire const& q, std::size_t item, std::vector<PageLine> const& lines,
                    std::optional<double>& answer);
    using Clock = InputEvent::Clock;
    class Trial; ///< the running trial

    ScreenSwap present(ScreenContent content);
    /// Switches to another viewer if it is not the current one; asks the participant
    /// to put a headset on or take it off.
    void see_in(StimulusViewer viewer);
    void between_frames();
    /// Function that returns the walls' views for a source; empty in a window.
    std::function<std::vector<ViewCommand>(gi::Camera const&)> on_walls();
    bool should_end() const { return experimenter_.wants_end(); }
    StimulusSource& source(std::size_t number, study::Stimuli kind, StimulusSettings const& stimulus);
    /// Shows text, 30 times per second, until `done` or `over` returns true.
    /// Returns false if the experimenter ends it.
    bool page(std::function<void(glm::vec2)> const& text, std::function<bool(InputEvent const&)> const& done,
              std::function<bool()> const& over = {});
    bool heed_window(InputEvent const& event);
    void end_early();
    /// Records the pose of the first view at the rate record.head_pose_hz.
    void keep_pose(double time_s, std::vector<ViewCommand> const& views);
    bool is_confirm(InputEvent const& event) const;
    std::string confirm_hint(std::string const& what) const;
    double seconds(Clock::time_point t) const;
    void add_patch(ScreenContent& content, bool white) const;
    study::DisplayModel const* model() const { return options_.screen.model ? &*options_.screen.model : nullptr; }
    bool has_degrees() const { return model() && model()->screen && model()->screen->distance_cm > 0; }
    /// For blocks with rules of gaze.
    study::ScreenGeometry const& gaze_screen() const { return *model()->screen; }
    std::optional<GazeCircle> gaze_circle(study::GazeCircleRule const& rule);
    void keep_gaze_table();

    study::Script const& script_;
    TrialOptions const& options_;
    gi::Report& report_;
    SessionClock clock_;    ///< for the sources; starts with this object
    StimulusViewer viewer_; ///< type of the current screen
    std::unique_ptr<Screen> screen_;
    AnswerKeys keys_;
    Markers markers_;
    Experimenter experimenter_;
    FrameTable table_;
    GazeRecorder gaze_;
    std::shared_ptr<InverseTable const> table_light_; ///< of a display model with luminance; null = none
    std::vector<std::unique_ptr<StimulusSource>> live_, prepared_, ar_,
        ar_prepared_;            ///< indexed by the stimulus's number in the trial
    double period_s_ = 1.0 / 60; ///< of the display's refresh
    bool paced_ = false;         ///< swaps do not wait for the display, so they are paced at expected_hz
    Clock::time_point next_swap_;
    Clock::time_point escaped_{}; ///< time of the last press of escape
    double last_pose_s_ = -1e9;
    double trial_end_s_ = 0; ///< end of the previous trial
};

} // namespace viewer
