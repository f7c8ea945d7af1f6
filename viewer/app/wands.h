#pragma once
// The wands of a display: they navigate, select, and open the panel as a menu on the wall that they point at.

#include "viewer/app/presenter.h"
#include "viewer/app/view_core.h"
#include "viewer/app/wand_input.h"
#include "viewer/devices/gl/panel_picture.h"

namespace viewer {

class Wands {
public:
    /// @param rank  whose walls can show the menu; -1 = all. The display must outlive it.
    Wands(Display const& display, int rank);

    bool any() const { return !inputs_.empty(); }
    /// Acts on buttons; returns the motion for this step, in the terms of the navigation.
    /// @param states  one per wand  @param world_from_room  rigid
    NavigationInput step(std::vector<WandState> const& states, ViewCore& core, gi::dmat4 const& world_from_room,
                         double seconds);
    bool menu_is_open() const { return menu_.has_value(); }
    /// True if the menu has changed since it was last drawn, or must be drawn again.
    bool wants_picture(double now_s) const;
    /// Fills the open menu. On the thread of input; not while another thread draws.
    void prepare(ViewState& state, double frames_per_s, double now_s);
    /// The menu as prepared; null if there is none yet. @param gl  of any window, current
    std::shared_ptr<WallOverlay const> draw(GlContext const& gl);

private:
    struct Menu {
        int wall = 0;
        WallRectangle place;
        glm::ivec2 size_px{};
        float font_px = 16;

        bool operator==(Menu const&) const = default;
    };
    void toggle(std::optional<RoomPose> const& wand, ViewState& state);
    std::optional<glm::dvec2> pointer_of(WandState const& wand) const;

    Display const& display_;
    int rank_;
    std::vector<WandInput> inputs_;
    std::optional<Menu> menu_, prepared_;
    std::unique_ptr<PanelPicture> panel_;
    bool filled_ = false; ///< the panel holds the prepared menu
    std::optional<glm::dvec2> pointer_px_, prepared_pointer_px_;
    bool pressed_ = false, prepared_pressed_ = false;
    double scroll_ = 0, prepared_s_ = 0;
};

} // namespace viewer
