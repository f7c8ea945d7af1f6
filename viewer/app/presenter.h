#pragma once
// Shows the newest frame in one window: its views are drawn for the current head pose, composed for stereo, and warped
// and blended for walls.

#include "gi/light_paths/settings.h"
#include "viewer/app/shown_views.h"
#include "viewer/app/still_fade.h"
#include "viewer/app/surface_display.h"
#include "viewer/devices/gl/surface_pass.h"
#include "viewer/devices/gl/wall_pass.h"
#include "viewer/displays/wall_ray.h"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <optional>

namespace viewer {

/// The views of one eye on a wall that is not flat.
struct PaneFaces {
    std::vector<int> views;
    std::vector<CubeFace> faces; ///< of each view
    gi::dvec3 eye_m{0};          ///< in the room
};

/// Part of a window and the views that it shows.
struct Pane {
    glm::ivec2 corner_px{}, size_px{}; ///< from the window's top left corner
    StereoMode stereo = StereoMode::off;
    int left = -1, right = -1;             ///< views of the frame; -1 = none, stays dark
    bool right_alone = false;              ///< shows only the right eye: second of two windows
    int of_wall = -1;                      ///< wall of the display that it shows; -1 = none
    int wall = -1;                         ///< index into the walls' settings; -1 = flat, without a wall pass
    PaneFaces left_faces{}, right_faces{}; ///< replace left and right on a wall with a curved surface
};

/// A picture on a part of a wall, at the wall's distance for both eyes.
struct WallOverlay {
    int wall = 0;
    WallRectangle place;
    glm::ivec2 size_px{};
    std::vector<unsigned char> rgb; ///< rows from the top
};

struct PresentSettings {
    std::shared_ptr<WallOverlay const> overlay; ///< null = none
    gi::ToneMapSettings tone;
    DisplayLight light; ///< of panes that show no wall with a pass of its own (whose blend and gain count instead)
    Comparison comparison = Comparison::off;
    float split = 0.5f;
    bool swap_eyes = false;
    std::optional<FrameCommand> moment; ///< in which objects and bodies are shown; empty: that of the frame
    DriveBodies drive;                  ///< moves bodies then
    /// Side of surfaces drawn for a newer camera over that of the view; 0: pictures are reprojected.
    double surfaces_scale = 0;
    bool fades = false; ///< pictures of a head that stands still fade in
    /// Of what ranks show together: drawn again, it fades no further. 0 = alone, each drawing is a step.
    std::uint64_t moment_number = 0;
};

class Presenter {
public:
    /// The window's context must be current, here and in all calls.
    /// @param walls  settings of the walls that panes refer to; creates their passes
    explicit Presenter(std::vector<WallSettings> const& walls);

    /// Uploads the views shown by these panes, and frees those that are not.
    void take(std::shared_ptr<LiveFrame const> frame, std::vector<Pane> const& panes);
    /// Draws the panes; pixels outside of them stay unchanged.
    /// @param on_screen_px  position of the target's top left corner
    /// @param now  one camera per view, for reprojection; empty = as rendered
    void draw(DrawTarget const& whole, glm::ivec2 on_screen_px, std::vector<Pane> const& panes,
              PresentSettings const& settings, std::vector<gi::Camera> const& now);
    /// Draw again soon: a picture fades in.
    bool fades() const
    {
        return views_.fades() || std::ranges::any_of(fades_, [](auto const& f) { return f.second.fades(); });
    }
    ShownViews const& views() const { return views_; }
    ShownViews& views() { return views_; }

private:
    /// What one eye sees in a pane.
    struct SeenView {
        int view = -1;
        EyeView picture;
        gi::Camera camera;        ///< for which it is shown
        bool as_rendered = false; ///< that of the frame
    };
    using ViewOfPane = SurfaceDisplay::Key;
    /// Of all panes.
    struct Drawing {
        PresentSettings const& settings;
        std::vector<gi::Camera> const& now;
        std::map<ViewOfPane, TextureTarget const*> encoded; ///< so far
    };
    SeenView see(int view, Drawing const& d);
    /// Of a pane: left and right, as they reach the eyes. Without textures: not shown.
    std::array<SeenView, 2> see(Pane const& pane, Drawing const& d);
    static bool encodes(SeenView const& seen, DisplaySettings const& settings, Drawing const& d);
    TextureTarget const& encoded(std::size_t pane, SeenView const& seen, glm::ivec2 size_px,
                                 DisplaySettings settings, Drawing& d);
    /// One eye, or both eyes composed for stereo.
    void show(std::size_t pane, DrawTarget const& to, SeenView const& left, SeenView const& right,
              DisplaySettings const& settings, Drawing& d);
    /// Bends the pictures of one wall into bent_. False if it has none.
    bool bend(std::size_t number, Pane const& pane, DisplaySettings const& settings, Drawing& d,
              WallPass::Outside outside);
    /// The picture of one eye on a wall that is not flat, in flat_.
    void draw_faces(std::size_t number, Pane const& pane, PaneFaces const& faces, DisplaySettings const& settings,
                    std::size_t side, Drawing& d);
    void draw_overlay(std::shared_ptr<WallOverlay const> const& overlay, DrawTarget const& wall_picture);

    std::shared_ptr<WallOverlay const> uploaded_;
    std::optional<TextureTarget> overlay_picture_;
    ShownViews views_;
    DisplayPass pass_;
    std::deque<WallPass> walls_;
    std::deque<std::optional<SurfacePass>> surfaces_; ///< of the walls that have one
    std::deque<TextureTarget> face_targets_;
    std::array<std::optional<TextureTarget>, 2> flat_, bent_;
    std::optional<SurfaceDisplay> surface_display_;
    FadePass fade_pass_;
    std::map<ViewOfPane, StillFade> fades_;
    glm::ivec2 bent_px_{};
};

} // namespace viewer
