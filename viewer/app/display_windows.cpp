#include "viewer/app/display_windows.h"

#include "viewer/app/layout.h"

#include <algorithm>

namespace viewer {

DisplayWindows open_windows(Display& display, int rank, int swap_interval, gi::Report& report,
                            std::function<void(ShownWindow&)> const& opened)
{
    DisplayWindows shown;
    shown.of.assign(display.windows.size(), -1);
    for (int const w : windows_of(display, rank)) {
        DisplayWindow const& wanted = display.windows[std::size_t(w)];
        WindowSettings settings;
        settings.title = "Lightwell: " + wanted.name;
        settings.size_px = {wanted.width_px, wanted.height_px};
        settings.swap_interval = swap_interval;
        settings.borders = wanted.borders;
        settings.swap_group = wanted.swap_group;
        settings.swap_barrier = wanted.swap_barrier;
        if (wanted.fullscreen) settings.monitor = std::to_string(std::max(0, wanted.monitor));
        settings.position_px = glm::ivec2{wanted.x_px, wanted.y_px};
        if (wanted.monitor >= 0 && !wanted.fullscreen)
            for (MonitorInfo const& m : monitors())
                if (m.number == wanted.monitor) *settings.position_px += m.position_px;
        for (Wall const& wall : display.walls)
            if (wall.window == w && wall.stereo == StereoMode::quad_buffer)
                settings.quad_buffer = QuadBuffer::wanted;
        shown.of[std::size_t(w)] = int(shown.windows.size());
        shown.windows.push_back(std::make_unique<ShownWindow>(settings, wall_settings(display), report));
        if (opened) opened(*shown.windows.back());
        if (shown.windows.back()->window.has_quad_buffer()) continue;
        for (Wall& wall : display.walls)
            if (wall.window == w && wall.stereo == StereoMode::quad_buffer) wall.stereo = StereoMode::side_by_side;
    }
    return shown;
}

void note_sizes(Display& display, DisplayWindows const& shown)
{
    for (std::size_t w = 0; w < shown.of.size(); ++w) {
        if (shown.of[w] < 0) continue;
        glm::ivec2 const px = shown.windows[std::size_t(shown.of[w])]->window.framebuffer_px();
        if (px.x <= 0 || px.y <= 0) continue; // minimised
        display.windows[w].width_px = px.x;
        display.windows[w].height_px = px.y;
    }
}

} // namespace viewer
