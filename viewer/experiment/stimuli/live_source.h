#pragma once
#include "viewer/experiment/stimuli/stimulus_place.h"

namespace viewer {

/// Renders stimuli while they are shown, in its own thread.
class LiveSource : public StimulusSource {
public:
    /// @param published  called on the rendering thread   All arguments must outlive it.
    LiveSource(SceneAccess const& scenes, int threads, SessionClock const& clock, std::function<void()> published,
               gi::Report& report);
    ~LiveSource() override;

    void prepare(StimulusSettings const& stimulus, StimulusView const& view) override;
    bool is_ready() override;
    void at(double seconds) override;
    void change(StimulusSettings const& stimulus) override;
    void walk(NavigationInput const& input, double seconds) override;
    void rest() override;
    bool moves() const override { return plays_ || stimulus_.path != StimulusPath::none; }
    std::shared_ptr<LiveFrame const> newest() override;
    std::optional<FrameCommand> moment(LiveFrame const& frame) override;
    void drawn_at(double scale) override { drawn_scale_ = scale; }

private:
    void post(Change const& change);
    void post_settings(Settings const& wanted);
    void look(double seconds);

    SceneAccess const& scenes_;
    SessionClock const& clock_;
    RenderSession session_;
    Settings posted_;   ///< settings posted to the session, applied now or soon
    std::string scene_; ///< likewise
    bool edited_ = false;
    StimulusSettings stimulus_;
    StimulusView view_;
    Viewpoint look_;         ///< the newest; no views while it rests
    double drawn_scale_ = 0; ///< of the surfaces that the screen draws

    std::mutex mutex_; ///< guards the members below, which the rendering thread writes
    std::string error_;
    std::optional<StimulusPlace> place_; ///< none = unknown yet
    double settled_s_ = 0;               ///< session clock: frames that began later use all settings
    int warm_frames_ = 0;                ///< number of such frames
    std::atomic<bool> plays_{false};     ///< clips play once it is shown
    double last_s_ = -1;
    std::optional<Navigation> navigation_; ///< during a walk
    std::unique_ptr<LiveRenderer> renderer_;
};

} // namespace viewer
