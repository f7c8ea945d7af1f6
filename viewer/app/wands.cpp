#include "viewer/app/wands.h"

#include "viewer/app/panel_contents.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr double kLetter_m = 0.03;       ///< height of letters on the wall
constexpr float kSmallestLetter_px = 16; ///< where the wall has fewer pixels, the menu is scaled down
constexpr double kMenu_Hz = 10;          ///< of an open menu that nobody points at: its figures change
constexpr double kScroll_per_s = 8;      ///< steps of a wheel at full deflection
constexpr double kLargest_px = 2048;

std::optional<Command> command_of(WandAction action)
{
    switch (action) {
    case WandAction::navigation:
        return Command::next_navigation;
    case WandAction::first_camera:
        return Command::first_camera;
    case WandAction::play:
        return Command::play;
    case WandAction::screenshot:
        return Command::screenshot;
    case WandAction::next_method:
        return Command::next_method;
    case WandAction::brighter:
        return Command::brighter;
    case WandAction::darker:
        return Command::darker;
    default:
        return {};
    }
}

/// Motion relative to the level room becomes motion relative to the navigation's view, which may look up or down.
NavigationInput in_view(NavigationInput in, Navigation const& navigation)
{
    if (navigation.mode() == NavigationMode::walk) return in;
    glm::dmat3 const room(navigation.world_from_room()), view(navigation.world_from_camera());
    gi::dvec3 const way = glm::transpose(view) * room * gi::dvec3{in.right, in.up, -in.forward};
    in.right = way.x;
    in.up = way.y;
    in.forward = -way.z;
    return in;
}

gi::dmat4 matrix(RoomPose const& p)
{
    gi::dmat4 m(glm::mat4_cast(p.rotation));
    m[3] = {p.position, 1};
    return m;
}

} // namespace

Wands::Wands(Display const& display, int rank) : display_(display), rank_(rank)
{
    for (DisplayTracker const& t : display.trackers)
        if (t.wand) inputs_.emplace_back(*t.wand);
}

void Wands::toggle(std::optional<RoomPose> const& wand, ViewState& state)
{
    if (menu_) {
        menu_.reset();
        return;
    }
    std::optional<WallHit> hit, elsewhere;
    if (wand) hit = hit_wall(display_, *wand, rank_);
    if (wand && !hit) elsewhere = hit_wall(display_, *wand);
    if (!hit) {
        auto const own = std::find_if(display_.walls.begin(), display_.walls.end(), [this](Wall const& w) {
            return (rank_ < 0 || w.rank == rank_) && !w.surface;
        });
        if (own == display_.walls.end()) {
            state.message = "no flat wall of this process can show the menu";
            return;
        }
        hit = WallHit{int(own - display_.walls.begin()), 0.5, 0.5, 0};
    }
    if (elsewhere)
        state.message = fmt::format("wall {} is drawn by rank {}: the menu is on wall {}",
                                    display_.walls[std::size_t(elsewhere->wall)].name,
                                    display_.walls[std::size_t(elsewhere->wall)].rank,
                                    display_.walls[std::size_t(hit->wall)].name);
    Wall const& wall = display_.walls[std::size_t(hit->wall)];
    WallFrame const frame = wall_frame(wall.corners);
    PixelRectangle const px = viewport_px(wall, display_.windows[std::size_t(wall.window)]);
    Menu menu;
    menu.wall = hit->wall;
    menu.place = menu_place(frame, hit->u, hit->v);
    double const per_m = px.width / frame.width_m;
    menu.font_px = std::max(kSmallestLetter_px, float(std::round(kLetter_m * per_m)));
    glm::dvec2 const letters =
        glm::dvec2(menu.place.width * frame.width_m, menu.place.height * frame.height_m) / kLetter_m;
    menu.size_px = glm::ivec2(glm::clamp(letters * double(menu.font_px), 64.0, kLargest_px));
    menu_ = menu;
}

std::optional<glm::dvec2> Wands::pointer_of(WandState const& wand) const
{
    if (!menu_ || !wand.pose || !wand.fresh) return {};
    auto const hit = hit_plane(display_, menu_->wall, *wand.pose);
    if (!hit) return {};
    glm::dvec2 const at = menu_->place.inside(*hit);
    if (at.x < 0 || at.x > 1 || at.y < 0 || at.y > 1) return {};
    return at * glm::dvec2(menu_->size_px);
}

NavigationInput Wands::step(std::vector<WandState> const& states, ViewCore& core, gi::dmat4 const& world_from_room,
                            double seconds)
{
    NavigationInput all;
    std::optional<glm::dvec2> pointer;
    bool pressed = false;
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        WandStep const step = inputs_[k].step(states[k], seconds);
        for (WandAction const action : step.pressed) {
            if (action == WandAction::menu) {
                toggle(states[k].pose, core.state);
            } else if (action == WandAction::select) {
                if (states[k].pose && !pointer_of(states[k]))
                    core.state.pick_along(world_from_room * matrix(*states[k].pose),
                                          [&state = core.state](std::optional<Selection> const& found) {
                                              state.selection = found;
                                              if (found) state.navigation.set_pivot(found->picked.position);
                                          });
            } else if (auto const command = command_of(action)) {
                core.obey(*command);
            }
        }
        if (auto const at = pointer_of(states[k]); at && !pointer) {
            pointer = at;
            pressed = step.selects;
            scroll_ += kScroll_per_s * step.scroll * seconds;
            continue; // pointing at the menu, the joystick scrolls it
        }
        NavigationInput const motion = in_view(step.motion, core.state.navigation);
        all.right += motion.right;
        all.up += motion.up;
        all.forward += motion.forward;
        all.turn_right_rad += motion.turn_right_rad;
    }
    pointer_px_ = pointer;
    pressed_ = pressed;
    return all;
}

bool Wands::wants_picture(double now_s) const
{
    if (!menu_) return prepared_.has_value(); // once more, without it
    if (prepared_ != menu_ || !filled_ || pressed_ != prepared_pressed_ || std::abs(scroll_) > 0.1) return true;
    if (pointer_px_.has_value() != prepared_pointer_px_.has_value()) return true;
    if (pointer_px_ && glm::distance(*pointer_px_, *prepared_pointer_px_) >= 1) return true;
    return now_s - prepared_s_ > 1 / kMenu_Hz;
}

void Wands::prepare(ViewState& state, double frames_per_s, double now_s)
{
    prepared_ = menu_;
    filled_ = false;
    if (!menu_ || !panel_ || panel_->size_px() != menu_->size_px) return; // draw makes the panel first
    panel_->begin(pointer_px_, pressed_, std::exchange(scroll_, 0), now_s - prepared_s_);
    fill_panel(state, frames_per_s, PanelPlace::alone);
    panel_->finish();
    filled_ = true;
    prepared_pointer_px_ = pointer_px_;
    prepared_pressed_ = pressed_;
    prepared_s_ = now_s;
}

std::shared_ptr<WallOverlay const> Wands::draw(GlContext const& gl)
{
    if (!prepared_) return nullptr;
    if (!panel_ || panel_->size_px() != prepared_->size_px) {
        panel_.reset();
        panel_ = std::make_unique<PanelPicture>(gl, prepared_->size_px, prepared_->font_px);
        return nullptr;
    }
    if (!filled_) return nullptr;
    auto const overlay = std::make_shared<WallOverlay>();
    overlay->wall = prepared_->wall;
    overlay->place = prepared_->place;
    overlay->size_px = prepared_->size_px;
    overlay->rgb = panel_->draw();
    return overlay;
}

} // namespace viewer
