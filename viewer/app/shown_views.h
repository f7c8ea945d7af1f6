#pragma once
// The views of the newest frame as a window or a headset shows them: uploaded once, and drawn for newer cameras, by
// their surfaces where these can be drawn, else by reprojection.

#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/reprojection.h"
#include "viewer/devices/gl/surface_renderer.h"
#include "viewer/engine/live/live_renderer.h"
#include "viewer/protocol/recording/recording.h"

#include <array>

namespace viewer {

/// The context that was current at its creation must be current in all calls.
class ShownViews {
public:
    /// Uploads these views of the frame, hidden pixels filled (fill_hidden), and frees the others. -1 = none.
    void take(std::shared_ptr<LiveFrame const> frame, std::vector<int> const& views);
    bool has_frame() const { return frame_ != nullptr; }
    ViewCommand const& command(int view) const { return frame_->command.views[std::size_t(view)]; }

    /// Before the views of a picture are drawn.
    /// @param surfaces_scale  side of surfaces over that of the view; 0: pictures are reprojected
    /// @param moment  in which objects and bodies are shown; null: that of the frame
    void begin(double surfaces_scale, FrameCommand const* moment, DriveBodies const& drive);
    /// Valid until the view's next one. @param now  null = as rendered
    EyeView eye(int view, gi::Camera const* now);
    /// The middle of a view, at this size. Valid until its next one. Not part of hash().
    EyeView middle(int view, gi::Camera const& now, glm::ivec2 size_px);
    /// Of what eye() or middle() returned last. Where surfaces are drawn, without blended ones.
    ShownDepth depth(int view, ViewPart part = ViewPart::whole) const
    {
        return views_[std::size_t(view)].depths[std::size_t(part)];
    }

    /// Of the surfaces that eye() drew last; none before. Waits for the GPU.
    LightSources light_sources(int view) const
    {
        return renderer_ ? renderer_->light_sources(view) : LightSources{};
    }

    LiveFrame const& frame() const { return *frame_; } ///< of the last take()
    /// True if surfaces are about to be drawn, once more of the scene is on the GPU: draw again soon.
    bool prepares() const { return prepares_; }
    bool drew_surfaces() const { return drew_surfaces_; } ///< since begin()
    /// Light fades in: draw again soon, even if nothing moves.
    bool fades() const { return drew_surfaces_ && renderer_ && renderer_->fades(); }
    /// Side of surfaces over that of the view, if any could be drawn since begin(); else 0.
    double drawn_scale() const { return is_ready_ ? surfaces_scale_ : 0; }
    /// Puts the rest of the scene on the GPU, however long it takes. False: surfaces cannot be drawn.
    bool make_ready();
    std::vector<int> const& drawn_views() const { return drawn_; } ///< in the order of eye() since begin()
    /// Hash of the linear pictures of all views since begin(), if hash_pictures() was called; reading them waits for the GPU.
    std::uint64_t hash() const;
    void hash_pictures() { hashes_pictures_ = true; }
    bool hashes_pictures() const { return hashes_pictures_; }
    /// True if surfaces of every view can be drawn: pictures may be of light alone.
    bool draws_surfaces() const;
    /// Why surfaces are not drawn although they should be; empty: they are, or will be.
    std::string const& why_no_surfaces() const { return why_no_surfaces_; }

private:
    struct Shown {
        PictureTexture picture;
        Reprojection reprojection, middle;
    };
    /// none = not shown.
    struct View {
        std::optional<Shown> own, other;
        std::array<ShownDepth, 2> depths;
    };
    void upload(std::optional<Shown>& to, gi::Picture const& picture, HiddenPixels const& hidden);
    bool has_surfaces() const { return surfaces_scale_ > 0 && renderer_ && frame_ && frame_->result.scene; }
    void prepare(double most_s);
    void number_views();
    /// Gives the light of all views to the renderer, once for each frame that needs it.
    void add_light();
    bool shows(int view) const;
    glm::ivec2 size_of(int view) const;
    /// Of the view's picture, with its margin.
    gi::Camera camera_of(int view) const;
    EyeView draw(int view, ViewPart part, gi::Camera const* now, glm::ivec2 size_px);
    /// The surfaces of a view for another camera than that of its picture; none if they cannot be drawn.
    std::optional<ShownPicture> surfaces(int view, ViewPart part, gi::Camera const& from, gi::Camera const& to,
                                         glm::ivec2 size_px);

    std::shared_ptr<ReprojectionPrograms const> reprojection_ = std::make_shared<ReprojectionPrograms>();
    std::vector<View> views_;
    std::optional<SurfaceRenderer> renderer_;
    double surfaces_scale_ = 0;
    std::optional<double> pose_s_; ///< of the moment of begin()
    bool is_ready_ = false; ///< at begin()
    bool prepares_ = false, drew_surfaces_ = false, hashes_pictures_ = false;
    std::vector<std::uint64_t> hashes_; ///< of views
    std::vector<int> drawn_;            ///< views, since begin()
    std::string why_no_surfaces_;
    gi::World const* tried_ = nullptr; ///< scene whose surfaces were drawn once
    std::shared_ptr<LiveFrame const> frame_;
    bool is_light_added_ = false; ///< of frame_
    std::vector<std::string> names_,
        lit_names_;                    ///< of all views, also those of other processes; when light was added
    std::vector<int> heads_;           ///< of the same, LightOfView::head
    std::vector<std::size_t> numbers_; ///< of the frame's views among them
    std::vector<float> color_, depth_; ///< copies with filled hidden pixels
};

/// Of the pictures of all windows, at least one.
std::uint64_t shown_hash(std::span<ShownViews const* const> windows);
/// What these windows drew since begin(), for a recording.
ShownFrame shown_frame(FrameCommand moment, std::span<ShownViews const* const> windows);

} // namespace viewer
