#include "viewer/experiment/screens/window_screen.h"

#include "viewer/app/layout.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/displays/edid.h"
#include "viewer/displays/views.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/experiment/screens/monitor_check.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {
namespace {

using Clock = InputEvent::Clock;
constexpr double kLook_s = 0.001;

double ms_between(Clock::time_point a, Clock::time_point b)
{
    return std::chrono::duration<double, std::milli>(b - a).count();
}

PresentSettings settings_of(LiveFrame const& frame)
{
    PresentSettings settings;
    settings.tone = tone_settings(frame.settings);
    settings.swap_eyes = frame.settings.swap_eyes;
    return settings;
}

} // namespace

WindowScreen::WindowScreen(ScreenSettings const& settings, gi::Report& report)
    : display_(settings.display), report_(report), last_look_(Clock::now())
{
    if (display_) {
        tracking_.emplace(*display_);
        shown_ = open_windows(*display_, -1, settings.window.swap_interval, report);
        note_sizes(*display_, shown_);
    } else {
        shown_.windows.push_back(
            std::make_unique<ShownWindow>(settings.window, std::vector<WallSettings>{}, report));
    }
    for (auto const& w : shown_.windows) { // compile now what draws pictures, not for the first stimulus
        w->window.gl().make_current();
        w->pictures();
    }
    monitor_ = monitor_of(first().window);
    if (settings.model && !display_) check_monitor(*settings.model, monitor_, report);
    first().window.gl().make_current();
    panel_ = std::make_unique<Panel>(first().window, settings.font_px);
    first().window.gl().release(); // to the drawing thread
}

WindowScreen::~WindowScreen()
{
    thread_.reset();
    first().window.gl().make_current();
    panel_.reset();
    presenters_.clear();
    following_.clear();
    gaze_.reset();
}

glm::ivec2 WindowScreen::size_px() const { return first().window.framebuffer_px(); }
double WindowScreen::refresh_hz() const { return first().window.refresh_hz(); }

std::vector<std::pair<std::string, std::string>> WindowScreen::about() const
{
    glm::ivec2 const px = size_px();
    std::vector<std::pair<std::string, std::string>> facts{
        {"display", display_ ? "walls: " + display_->name : fmt::format("window of {} x {} px", px.x, px.y)},
        {"window_px", fmt::format("{} x {}", px.x, px.y)},
        {"opengl", first().window.gl().description()}};
    if (auto const monitor = monitor_of(first().window)) {
        facts.emplace_back("monitor", to_text(*monitor));
        if (auto const edid = monitor_at(monitor->name)) facts.emplace_back("monitor_edid", to_text(*edid));
    }
    return facts;
}

GazePlace WindowScreen::gaze_place() const
{
    return {size_px(), first().window.position_px(), monitor_ ? monitor_->size_px : glm::ivec2(0),
            monitor_ ? monitor_->position_px : glm::ivec2(0)};
}

std::vector<ViewCommand> WindowScreen::own_views(gi::dmat4 const& world_from_camera, double steady_s)
{
    note_sizes(*display_, shown_);
    gi::dvec3 const rest = display_->users.empty() ? gi::dvec3{0} : resting_head(display_->users[0]).position;
    Navigation const upright(world_from_camera, 1, gi::dvec3(world_from_camera[3]));
    gi::dmat4 const world_from_room = upright.world_from_room() * glm::translate(gi::dmat4(1), -rest);
    {
        std::lock_guard const lock(room_mutex_);
        world_from_room_ = world_from_room;
    }
    return display_layout(*display_, tracking_->heads(steady_s), world_from_room).views;
}

void WindowScreen::look()
{
    wait_for_windows(kLook_s);
    take_events();
}

void WindowScreen::take_events()
{
    auto const now = Clock::now();
    longest_look_ms_ = std::max(longest_look_ms_, ms_between(last_look_, now));
    last_look_ = now;
    for (auto const& w : shown_.windows)
        for (InputEvent& e : w->window.take_events()) input_.push_back(e);
    gamepads_.poll(input_);
}

void WindowScreen::wait_until(Clock::time_point time)
{
    do look();
    while (Clock::now() < time);
}

std::vector<InputEvent> WindowScreen::take_input()
{
    poll_windows();
    take_events();
    return std::exchange(input_, {});
}

double WindowScreen::take_longest_look_ms()
{
    last_look_ = Clock::now();
    return std::exchange(longest_look_ms_, 0);
}

void WindowScreen::note_windows()
{
    for (auto const& w : shown_.windows) {
        w->shown_px = w->window.framebuffer_px();
        w->on_screen_px = w->window.position_px();
    }
}

/// Reads input meanwhile.
void WindowScreen::on_drawing_thread(std::function<void()> const& work)
{
    std::atomic<bool> done = false;
    thread_->start(work, [&] {
        done = true;
        glfwPostEmptyEvent();
    });
    while (!done || thread_->busy()) look();
}

void WindowScreen::make_ready(ScreenPane const& pane)
{
    ScreenContent content;
    content.panes = {pane};
    content.panes[0].moment = pane.frame->command; // nothing moves while drivers compile
    note_windows();
    on_drawing_thread([&] {
        Surfaces surfaces;
        do {
            surfaces = {std::vector<char>(1)};
            for (auto const& w : shown_.windows) {
                w->window.gl().make_current();
                draw_pictures(target_of(w->window), *w, content, surfaces);
            }
        } while (surfaces.prepare);
        for (auto const& w : shown_.windows) w->window.gl().release();
    });
}

ScreenSwap WindowScreen::present(ScreenContent const& content)
{
    note_windows();
    if (content.text) {
        panel_->begin();
        content.text(first().shown_px);
        panel_->finish();
    }
    ScreenSwap swap;
    on_drawing_thread([&] { swap = draw(content); });
    return swap;
}

bool WindowScreen::draw_pane(Presenter& presenter, DrawTarget const& whole, glm::ivec2 on_screen_px,
                             std::vector<Pane> const& panes, ScreenPane const& pane, PresentSettings settings,
                             Surfaces& surfaces)
{
    std::vector<gi::Camera> now;
    if (pane.moment) {
        settings.moment = pane.moment;
        settings.surfaces_scale = surfaces_scale_.next();
        for (ViewCommand const& v : pane.moment->views) now.push_back(v.camera);
    }
    presenter.draw(whole, on_screen_px, panes, settings, now);
    if (!pane.moment) return false;
    ShownViews const& views = presenter.views();
    surfaces.wanted = true;
    surfaces.prepare |= views.prepares();
    surfaces.can_be_drawn &= views.draws_surfaces();
    if (!views.why_no_surfaces().empty() && !std::exchange(no_surfaces_told_, true))
        report_.lose("surfaces not drawn, pictures are reprojected", 1, views.why_no_surfaces());
    return views.drew_surfaces();
}

void WindowScreen::draw_panes(DrawTarget const& whole, ScreenContent const& content, Surfaces& surfaces)
{
    for (std::size_t k = 0; k < content.panes.size(); ++k) {
        ScreenPane const& p = content.panes[k];
        if (!p.frame) continue;
        std::deque<Presenter>& presenters = p.moment ? following_ : presenters_;
        auto& all_taken = p.moment ? following_taken_ : taken_;
        std::size_t const n = p.moment ? p.stimulus : k;
        while (presenters.size() <= n) presenters.emplace_back(std::vector<WallSettings>{});
        all_taken.resize(presenters.size());
        int const right = p.frame->command.views.size() > 1 ? 1 : -1;
        std::vector<Pane> const panes{{p.corner_px, p.size_px, p.stereo, 0, right}};
        if (all_taken[n] != p.frame) presenters[n].take(p.frame, panes);
        all_taken[n] = p.frame;
        PresentSettings settings = settings_of(*p.frame);
        settings.light = p.light;
        surfaces.drawn[k] = draw_pane(presenters[n], whole, first().on_screen_px, panes, p, settings, surfaces);
    }
    if (!content.gaze) return;
    if (!gaze_) gaze_.emplace();
    gaze_->draw(whole, content.gaze->is_window ? GazePass::Hidden::outside : GazePass::Hidden::inside,
                content.gaze->centre_px, content.gaze->radius_px, content.gaze->edge_px, ScreenContent::kGrey);
}

void WindowScreen::draw_walls(DrawTarget const& whole, ShownWindow& window, ScreenContent const& content,
                              Surfaces& surfaces)
{
    if (content.panes.empty() || !content.panes[0].frame) return;
    auto const& frame = content.panes[0].frame;
    auto const at = std::find_if(shown_.windows.begin(), shown_.windows.end(),
                                 [&](auto const& w) { return w.get() == &window; });
    auto const number = std::find(shown_.of.begin(), shown_.of.end(), int(at - shown_.windows.begin()));
    gi::dmat4 world_from_room(1);
    {
        std::lock_guard const lock(room_mutex_);
        world_from_room = world_from_room_;
    }
    auto const panes =
        display_panes(*display_, frame->command.views, world_from_room)[std::size_t(number - shown_.of.begin())];
    taken_.resize(shown_.windows.size());
    auto& taken = taken_[std::size_t(at - shown_.windows.begin())];
    if (taken != frame) window.pictures().take(frame, panes);
    taken = frame;
    surfaces.drawn[0] |= char(draw_pane(window.pictures(), whole, window.on_screen_px, panes, content.panes[0],
                                        settings_of(*frame), surfaces));
}

void WindowScreen::draw_pictures(DrawTarget const& whole, ShownWindow& window, ScreenContent const& content,
                                 Surfaces& surfaces)
{
    if (display_)
        draw_walls(whole, window, content, surfaces);
    else
        draw_panes(whole, content, surfaces);
}

/// Runs on the drawing thread. Draws all windows first and then swaps them, so that they change together.
ScreenSwap WindowScreen::draw(ScreenContent const& content)
{
    auto const begun = Clock::now();
    double const scale = surfaces_scale_.next();
    Surfaces surfaces{std::vector<char>(content.panes.size())};
    for (auto const& w : shown_.windows) {
        w->window.gl().make_current();
        DrawTarget const whole = target_of(w->window);
        clear(whole, ScreenContent::kGrey);
        draw_pictures(whole, *w, content, surfaces);
        if (w.get() != &first()) continue;
        if (content.text) panel_->draw();
        if (content.patch_size_px.x > 0)
            clear(part_of(whole, content.patch_corner_px, content.patch_size_px), content.patch_is_white ? 1 : 0);
    }
    SwapTime swap;
    for (auto const& w : shown_.windows) {
        w->window.gl().make_current();
        swap = w->timer.swap();
    }
    for (auto const& w : shown_.windows) w->window.gl().release();
    if (std::ranges::find(surfaces.drawn, 1) != surfaces.drawn.end())
        surfaces_scale_.measured(scale, 1e-3 * ms_between(begun, swap.time));
    return {swap.time,
            swap.seen,
            swap.uncertainty_ms,
            swap.method == GlSwapMethod::sync_control ? "oml" : "swap_finish",
            std::move(surfaces.drawn),
            surfaces.wanted && surfaces.can_be_drawn ? surfaces_scale_.next() : 0};
}

} // namespace viewer
