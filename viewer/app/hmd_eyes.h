#pragma once
// The two eye pictures of a frame for a headset, reprojected to the current eye poses,
// in textures for the runtime.

#include "gi/light_paths/settings.h"
#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/reprojection.h"
#include "viewer/devices/gl/window.h"
#include "viewer/engine/live/live_renderer.h"

namespace viewer {

/// OpenGL context: surfaceless without a display server, else of a window.
struct HmdContext {
    std::unique_ptr<Window> window;
    std::optional<GlContext> own;

    /// @param size_px, visibility  of the window
    HmdContext(gi::Report& report, WindowSettings const& settings);
    GlContext const& gl() const { return window ? window->gl() : *own; }
};

/// The context must be current in all calls.
class HmdEyes {
public:
    /// Uploads the pictures of both eyes, with hidden pixels filled (fill_hidden).
    void take(LiveFrame const& frame);
    /// Draws the frame taken last, reprojected to `now`, into the targets.
    void draw(LiveFrame const& frame, std::array<gi::Camera, 2> const& now,
              std::array<glm::ivec2, 2> const& sizes_px, bool reproject, gi::ToneMapSettings const& tone);
    /// Fills both targets with one grey (0..1).
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
    std::vector<float> color_, depth_; ///< copies with filled hidden pixels
};

} // namespace viewer
