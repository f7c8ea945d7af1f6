#pragma once
// Fades from what a pane showed to the next picture of a head that stands still: from drawn surfaces to the first rendered
// picture, and from each picture that refines to the next. Otherwise noise would jump with each of them.

#include "viewer/app/surface_display.h"
#include "viewer/devices/gl/fade_pass.h"

#include <optional>

namespace viewer {

/// A rendered picture of a head that stands still.
struct StillPicture {
    std::uint64_t frame = 0; ///< another number for each
    int still_frames = 1;    ///< that it is the mean of; 1: something has moved before
    std::uint64_t moment = 0; ///< PresentSettings::moment_number
};

/// What one eye sees in one pane, step by step. Belongs to the context that was current at its creation.
class StillFade {
public:
    /// The first picture takes so many steps. The next ones change less, and take fewer.
    static constexpr int kSteps = 16;

    /// The picture to show, encoded, of this size; valid until the next draw(). The first time, it begins to fade in if the
    /// pane shows the same view of a scene that stands still. @param settings  without stereo
    TextureTarget const& draw(DisplayPass& pass, FadePass const& fade, glm::ivec2 size_px, EyeView const& view,
                              gi::Camera const& camera, StillPicture picture, DisplaySettings const& settings);
    /// The pane shows drawn surfaces of this camera now. @param drawn  encoded; valid until the next draw()
    void show_surfaces(TextureTarget const& drawn, gi::Camera const& camera, gi::ToneMapSettings const& tone);
    /// The pane shows something else.
    void forget();
    /// Draw again soon: the last picture has not its full share yet.
    bool fades() const { return share_ < 1; }

private:
    void need(std::optional<TextureTarget>& target);

    glm::ivec2 size_px_{0};
    std::optional<TextureTarget> before_, after_, mixed_; ///< the first and the last while something fades in
    TextureTarget const* surfaces_ = nullptr; ///< that are shown; null: before_ and after_
    std::optional<gi::Camera> shown_;         ///< camera
    std::uint64_t frame_ = 0, moment_ = 0;    ///< of what was shown last
    gi::ToneMapSettings tone_;
    float share_ = 1; ///< of after_ in what is shown
};

} // namespace viewer
