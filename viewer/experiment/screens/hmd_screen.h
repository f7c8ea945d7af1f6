#pragma once
// A headset through OpenXR. Onsets are the runtime's predicted display times, and are labelled as predictions.
// Text floats in front of the head, and is also shown in a window of the computer, which receives the keyboard.

#include "viewer/app/hmd_eyes.h"
#include "viewer/app/surfaces_scale.h"
#include "viewer/devices/gl/gamepads.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/devices/xr/keeper.h"
#include "viewer/experiment/screens/screen_settings.h"

namespace viewer {

class HmdScreen : public Screen {
public:
    /// Throws InputError if there is no runtime, headset or window.
    HmdScreen(ScreenSettings const& settings, HmdOptions const& headset, gi::Report& report);
    ~HmdScreen() override;

    glm::ivec2 size_px() const override;
    double refresh_hz() const override;
    std::vector<std::pair<std::string, std::string>> about() const override;
    void make_ready(ScreenPane const& pane) override;
    ScreenSwap present(ScreenContent const& content) override;
    void wait_until(InputEvent::Clock::time_point time) override;
    std::vector<InputEvent> take_input() override;
    double take_longest_look_ms() override { return std::exchange(longest_look_ms_, 0); }
    GazePlace gaze_place() const override { return {size_px(), {}, {}, {}}; }
    /// Samples are read once a frame. Their pixels are those of the text's window, which floats straight ahead.
    std::vector<study::GazeSample> take_gaze() override { return std::exchange(gaze_, {}); }
    std::vector<std::pair<std::string, std::string>> gaze_about() const override;
    bool has_own_views() const override { return true; }
    std::vector<ViewCommand> own_views(gi::dmat4 const& world_from_camera, double steady_s) override;

private:
    std::optional<HmdFrame> next_frame(HmdSession*& session);
    void look(HmdFrame const& frame);
    void draw_text(ScreenContent const& content);
    void place_text(HmdFrame const& frame);
    gi::dmat4 world_from_room() const;
    double px_per_tangent() const; ///< of the text's window

    HmdContext context_;
    std::unique_ptr<Panel> panel_;
    HmdEyes eyes_;
    Gamepads gamepads_;
    HmdFrame frame_; ///< the last one
    std::array<HmdHand, 2> hands_;
    std::vector<InputEvent> input_;
    std::vector<study::GazeSample> gaze_;
    double last_gaze_s_ = 0;
    std::shared_ptr<LiveFrame const> taken_;
    gi::dmat4 world_from_camera_{1}; ///< of the stimulus
    std::optional<gi::dvec3> start_; ///< first position of the head, in the room
    InputEvent::Clock::time_point last_look_;
    double longest_look_ms_ = 0;
    gi::Report& report_;
    SurfacesScale surfaces_scale_;
    bool patch_told_ = false, no_surfaces_told_ = false;
    HmdKeeper keeper_; ///< declared last, so that its sessions end before the context
};

} // namespace viewer
