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

/// What an eye sees, or (the third and fourth one) the middle of it.
struct EyeToDraw {
    std::optional<gi::Camera> now; ///< none = as rendered; the middle needs one
    glm::ivec2 size_px{};
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
    /// Before draw(), if surfaces are to be drawn: as ShownViews::begin, and the GPU starts with what depends on no pose.
    void begin(double surfaces_scale, FrameCommand const& moment, DriveBodies const& drive);
    /// Draws the frame taken last.
    void draw(std::vector<EyeToDraw> const& eyes, gi::ToneMapSettings const& tone);
    ShownViews& views() { return views_; }
    /// That the GPU took for the last draw() that it has finished; 0: not known yet.
    double drawing_s();
    /// Fills the pictures with one grey (0..1).
    void clear(std::vector<glm::ivec2> const& sizes_px, float grey);
    /// The picture of an eye, at the size of its view.
    DrawTarget target(std::size_t eye);
    /// As they were drawn last; their sizes are those of the views, or smaller where surfaces were drawn.
    std::vector<unsigned> textures() const;
    std::vector<ShownDepth> depths() const;

private:
    struct Eye {
        TextureTarget target;                    ///< at the size of the view
        TextureTarget const* surfaces = nullptr; ///< shown instead, where surfaces were drawn
        ShownDepth depth;
    };
    void fit(std::size_t eye, glm::ivec2 size_px);

    DisplayPass pass_;
    ShownViews views_;
    std::optional<SurfaceDisplay> surface_display_; ///< once surfaces may be drawn
    std::vector<Eye> eyes_;
    GlObject begun_{GlObject::Kind::time}, ended_{GlObject::Kind::time};
    bool is_timed_ = false; ///< a draw() whose times are not known yet
    double drawing_s_ = 0;
};

} // namespace viewer
