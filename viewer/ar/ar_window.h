#pragma once
// The window of an AR session: the composite, or it and the camera's frame side by side, and a panel with what was
// measured. The bytes that are shown are those of the result.

#include "viewer/ar/runner.h"
#include "viewer/gl/gl_object.h"
#include "viewer/gl/panel.h"
#include "viewer/gl/window.h"

namespace viewer {

struct ArWindowSettings {
    glm::ivec2 size_px{};  ///< of frames
    std::string monitor;   ///< as WindowSettings
    int swap_interval = 0; ///< a camera's frames are not waited for by the monitor
    Visibility visibility = Visibility::shown;
};

class ArWindow {
public:
    ArWindow(ArWindowSettings const& settings, gi::Report& report);

    /// Draws and swaps; afterwards `record.present_ms` and, for frames with times, `record.swapped_ms` are known:
    /// since capture, when the swap came back and the GPU was done. Keys: S before and after side by side, H
    /// panel, Escape ends.
    void show(ArFrameRecord& record, ArResult const& result);
    bool wants_close() const { return wants_close_; }
    /// Between frames: keys and the window's own buttons.
    void idle() { take_input(); }

private:
    void take_input();
    void fill_panel(ArFrameRecord const& record);
    void draw(cv::Mat const& rgb);

    Window window_;
    Panel panel_;
    GlObject texture_, framebuffer_;
    std::vector<float> latency_ms_; ///< of the last frames
    bool is_split_ = false, has_panel_ = true, wants_close_ = false;
    std::uint64_t frames_ = 0, lost_ = 0;
};

} // namespace viewer
