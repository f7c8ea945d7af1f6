#pragma once
// A window, or the walls of a display. A separate thread draws and swaps, so that input is read while it waits for
// the display; present() reads input and returns when the swap is done.

#include "viewer/app/display_windows.h"
#include "viewer/app/present_thread.h"
#include "viewer/app/surfaces_scale.h"
#include "viewer/app/user_tracking.h"
#include "viewer/devices/gl/gamepads.h"
#include "viewer/devices/gl/gaze_pass.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/experiment/screens/screen_settings.h"

#include <mutex>

namespace viewer {

class WindowScreen : public Screen {
public:
    /// @param report  must outlive this. Throws InputError if no window can be opened.
    WindowScreen(ScreenSettings const& settings, gi::Report& report);
    ~WindowScreen() override;

    glm::ivec2 size_px() const override;
    double refresh_hz() const override;
    std::vector<std::pair<std::string, std::string>> about() const override;
    void make_ready(ScreenPane const& pane) override;
    ScreenSwap present(ScreenContent const& content) override;
    void wait_until(InputEvent::Clock::time_point time) override;
    std::vector<InputEvent> take_input() override;
    double take_longest_look_ms() override;
    GazePlace gaze_place() const override;
    bool has_own_views() const override { return display_.has_value(); }
    std::vector<ViewCommand> own_views(gi::dmat4 const& world_from_camera, double steady_s) override;
    Window const& window() const { return first().window; } ///< the first one

private:
    void look();
    void take_events();
    /// Of the surfaces of panes with a moment.
    struct Surfaces {
        std::vector<char> drawn; ///< per pane
        bool wanted = false;     ///< by any pane
        bool prepare = false;    ///< they will be drawn when more of the scene is on the GPU
        bool can_be_drawn = true;
    };
    void note_windows();
    void on_drawing_thread(std::function<void()> const& work);
    ScreenSwap draw(ScreenContent const& content);
    void draw_pictures(DrawTarget const& whole, ShownWindow& window, ScreenContent const& content,
                       Surfaces& surfaces);
    void draw_panes(DrawTarget const& whole, ScreenContent const& content, Surfaces& surfaces);
    void draw_walls(DrawTarget const& whole, ShownWindow& window, ScreenContent const& content,
                    Surfaces& surfaces);
    /// @return whether surfaces were drawn for the pane's moment
    bool draw_pane(Presenter& presenter, DrawTarget const& whole, glm::ivec2 on_screen_px,
                   std::vector<Pane> const& panes, ScreenPane const& pane, PresentSettings settings,
                   Surfaces& surfaces);
    ShownWindow& first() const { return *shown_.windows.front(); }

    std::optional<Display> display_;
    std::optional<MonitorInfo> monitor_; ///< under the first window when it opened
    std::mutex room_mutex_;
    gi::dmat4 world_from_room_{1};         ///< at the last views; the drawing thread reads it
    std::optional<UserTracking> tracking_; ///< for a display
    DisplayWindows shown_;                 ///< one window without a display
    std::unique_ptr<Panel> panel_;
    std::deque<Presenter> presenters_; ///< one per pane without a moment
    std::deque<Presenter> following_;  ///< one per stimulus with one
    SurfacesScale surfaces_scale_;     ///< of the drawing thread
    gi::Report& report_;
    bool no_surfaces_told_ = false;
    std::optional<GazePass> gaze_;
    std::vector<std::shared_ptr<LiveFrame const>> taken_, following_taken_; ///< of the presenters
    std::vector<InputEvent> input_;
    InputEvent::Clock::time_point last_look_;
    double longest_look_ms_ = 0;
    Gamepads gamepads_;
    std::unique_ptr<PresentThread> thread_ = std::make_unique<PresentThread>();
};

} // namespace viewer
