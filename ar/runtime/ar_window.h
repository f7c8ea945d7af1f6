#pragma once
// The window of an AR session: the composite, or it and the camera's frame side by side, and a panel with what was
// measured. The bytes that are shown are those of the result; or those that the GPU makes of its parts, which
// differ from them by one at most.

#include "ar/runtime/runner.h"
#include "viewer/devices/gl/ar_composite_pass.h"
#include "viewer/devices/gl/gl_object.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/devices/gl/window.h"

namespace viewer {

struct ArWindowSettings {
    glm::ivec2 size_px{};     ///< of frames
    std::string monitor = {}; ///< as WindowSettings
    int swap_interval = 0;    ///< a camera's frames are not waited for by the monitor
    Visibility visibility = Visibility::shown;
    /// Composites are made here, of results without (CompositeBy::window); null = they come with the results.
    ar::Compositor const* compositor = nullptr;
    bool has_panel = true;
    bool keeps_shown = false; ///< see `shown`
};

class ArWindow {
public:
    ArWindow(ArWindowSettings const& settings, gi::Report& report);

    /// Draws and swaps; afterwards `record.present_ms` and, for frames with times, `record.swapped_ms` are known:
    /// since capture, when the swap came back and the GPU was done. Keys: S before and after side by side, H
    /// panel, Escape ends.
    void show(ArFrameRecord& record, ArResult const& result);
    /// What the window had where the frame is when it was swapped, as it was read back: CV_8UC3 RGB.
    cv::Mat const& shown() const { return shown_; }
    bool wants_close() const { return wants_close_; }
    /// Between frames: keys and the window's own buttons.
    void idle() { take_input(); }

private:
    void take_input();
    void fill_panel(ArFrameRecord const& record);
    /// Its texture.
    unsigned composite(ArFrameRecord const& record, ArResult const& result);
    /// @param share  of its width, from the left
    void draw(unsigned texture, cv::Size picture, double share);
    void keep_shown(cv::Size picture);

    ArWindowSettings settings_;
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
