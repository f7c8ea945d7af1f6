#pragma once
// The two pictures of a frame as a headset's eyes see them: brought to where the eyes are now, on textures that
// can be handed to the runtime.

#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/reprojection.h"
#include "viewer/devices/gl/window.h"
#include "viewer/engine/live/live_renderer.h"

namespace viewer {

/// Surfaceless where there is no display server, else of a window.
struct HmdContext {
    std::unique_ptr<Window> window;
    std::optional<GlContext> own;

    /// @param size_px, visibility  of the window
    HmdContext(gi::Report& report, WindowSettings const& settings);
    GlContext const& gl() const { return window ? window->gl() : *own; }
};

/// The context is current in all calls.
class HmdEyes {
public:
    /// Uploads the pictures of both eyes; hidden pixels as fill_hidden has it.
    void take(LiveFrame const& frame);
    /// Of the frame taken last, seen from `now`, into the targets.
    void draw(LiveFrame const& frame, std::array<gi::Camera, 2> const& now,
              std::array<glm::ivec2, 2> const& sizes_px, bool reproject, gi::ToneMapSettings const& tone);
    /// Empty ones, in one grey (0..1).
    void clear(std::array<glm::ivec2, 2> const& sizes_px, float grey);
    DrawTarget target(std::size_t eye) const { return targets_[eye]->target(); }
    std::array<unsigned, 2> textures() const
    {
        return {targets_[0]->shown().texture, targets_[1]->shown().texture};
    }

private:
    void make_targets(std::array<glm::ivec2, 2> const& sizes_px);

    DisplayPass pass_;
    std::array<PictureTexture, 2> pictures_;
    std::array<Reprojection, 2> reprojections_;
    std::array<std::optional<TextureTarget>, 2> targets_;
    std::array<glm::ivec2, 2> sizes_{};
    std::vector<float> color_, depth_; ///< that hidden pixels were filled in
};

} // namespace viewer
