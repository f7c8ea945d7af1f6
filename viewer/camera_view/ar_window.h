#pragma once
// The window of an AR session: the composite, alone or beside the camera's frame, and a panel with measurements.
// Shows the bytes of the result, or those of the GPU's composite, which differ by one at most.

#include "ar/runtime/runner.h"
#include "viewer/devices/gl/ar_composite_pass.h"
#include "viewer/devices/gl/gl_object.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/devices/gl/window.h"

namespace viewer {

struct ArWindowSettings {
    glm::ivec2 size_px{};     ///< of frames
    std::string monitor = {}; ///< as WindowSettings
    int swap_interval = 0;    ///< 0: do not wait for the monitor's refresh
    Visibility visibility = Visibility::shown;
    /// Compositor for compositing in the window (CompositeBy::window); null = the results contain composites.
    ar::Compositor const* compositor = nullptr;
    bool has_panel = true;
    bool keeps_shown = false; ///< see `shown`
};

class ArWindow {
public:
    /// @param report  counts frames of more than 8 bits, of which the window shows 8; must outlive the window
    ArWindow(ArWindowSettings const& settings, gi::Report& report);

    /// Draws and swaps; sets `record.present_ms` and, for frames with times, `record.swapped_ms`:
    /// the time from capture until the swap returned and the GPU had finished. Keys:
    /// S before and after side by side, H panel, Escape ends.
    void show(ar::RunFrame& record, ar::FrameResult const& result);
    /// The frame's area of the window at the swap, read back: CV_8UC3 RGB.
    cv::Mat const& shown() const { return shown_; }
    bool wants_close() const { return wants_close_; }
    /// Call between frames: handles keys and the window's buttons.
    void idle() { take_input(); }

private:
    void take_input();
    void fill_panel(ar::RunFrame const& record);
    /// Returns the texture of the composite.
    unsigned composite(ar::RunFrame const& record, ar::FrameResult const& result);
    /// @param share  part of the picture's width to draw, from the left
    void draw(unsigned texture, cv::Size picture, double share);
    void keep_shown(cv::Size picture);

    ArWindowSettings settings_;
    gi::Report& report_;
    Window window_;
    Panel panel_;
    std::optional<ArCompositePass> pass_;
    std::optional<TextureTarget> composited_;
    GlObject picture_, camera_, light_texture_, framebuffer_;
    cv::Mat light_, shown_;
    std::vector<float> latency_ms_; ///< of the last frames
    bool is_split_ = false, has_panel_, wants_close_ = false;
    std::uint64_t frames_ = 0, lost_ = 0;
};

} // namespace viewer
