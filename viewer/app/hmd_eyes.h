#pragma once
// The two eye pictures of a frame for a headset, drawn for the current eye poses, in textures for the runtime.

#include "gi/light_paths/settings.h"
#include "viewer/app/shown_views.h"
#include "viewer/app/surface_display.h"
#include "viewer/devices/gl/window.h"

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
    /// Uploads the pictures of both eyes.
    void take(std::shared_ptr<LiveFrame const> frame)
    {
        if (frame->result.scene && !surface_display_) surface_display_.emplace();
        views_.take(std::move(frame), {0, 1});
    }
    /// Draws the frame taken last into the targets, after views().begin() if surfaces are to be drawn. @param now  null: as rendered
    void draw(std::array<gi::Camera, 2> const* now, std::array<glm::ivec2, 2> const& sizes_px,
              gi::ToneMapSettings const& tone);
    ShownViews& views() { return views_; }
    /// That the GPU took for the last draw() that it has finished; 0: not known yet.
    double drawing_s() const { return drawing_s_; }
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
    ShownViews views_;
    std::optional<SurfaceDisplay> surface_display_; ///< once surfaces may be drawn
    std::array<std::optional<TextureTarget>, 2> targets_;
    std::array<glm::ivec2, 2> sizes_{};
    GlObject begun_{GlObject::Kind::time}, ended_{GlObject::Kind::time};
    bool is_timed_ = false; ///< a draw() whose times are not known yet
    double drawing_s_ = 0;
};

} // namespace viewer
