#pragma once
// Windows with their pictures and panels; opens those of a display file.

#include "viewer/app/loading_screen.h"
#include "viewer/app/presenter.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/devices/gl/swap_timer.h"
#include "viewer/devices/gl/window.h"
#include "viewer/displays/display.h"

#include <functional>
#include <memory>

namespace viewer {

/// A window and its contents. Windows appear before there is something to show, so the passes that draw pictures
/// are made for the first one.
struct ShownWindow {
    Window window;
    SwapTimer timer;
    std::unique_ptr<Panel> panel;         ///< over the picture; null = none
    std::vector<Pane> panes, shown_panes; ///< current ones; those being shown, as are the next two
    glm::ivec2 shown_px{}, on_screen_px{};

    ShownWindow(WindowSettings const& settings, std::vector<WallSettings> walls, gi::Report& report)
        : window(settings, report), timer(window, report), walls_(std::move(walls))
    {
    }
    /// Another window's context may be current, where the same names denote other objects.
    ~ShownWindow() { window.gl().make_current(); }

    /// The window's context must be current.
    Presenter& pictures()
    {
        if (!presenter_) presenter_.emplace(walls_);
        return *presenter_;
    }
    /// Adds the panel and draws the first loading screen, at once. Makes the context current.
    void show_loading(std::string const& scene, PanelInput input)
    {
        window.gl().make_current();
        panel = std::make_unique<Panel>(window, panel_font_px(window.content_scale()), input);
        panel->begin();
        fill_loading({scene, {"reading"}, 0, 0}, LoadingPlace::alone);
        panel->finish();
        clear(target_of(window));
        panel->draw();
        window.swap();
    }

private:
    std::vector<WallSettings> walls_;
    std::optional<Presenter> presenter_;
};

/// Windows of a display that this process shows.
struct DisplayWindows {
    std::vector<std::unique_ptr<ShownWindow>> windows;
    std::vector<int> of; ///< per window of the display: index into windows; -1 = shown by another process
};

/// Opens the windows. Falls back to side by side for walls whose window lacks quad buffers. Throws InputError.
/// @param rank  as in windows_of; -1 = all
/// @param opened  called for each window before the next is opened; may be empty
DisplayWindows open_windows(Display& display, int rank, int swap_interval, gi::Report& report,
                            std::function<void(ShownWindow&)> const& opened = {});
/// Sets the actual sizes of the windows, which may differ from those in the file.
void note_sizes(Display& display, DisplayWindows const& shown);

} // namespace viewer
