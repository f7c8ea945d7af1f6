#include "viewer/app/view_program.h"

#include "gi/core/error.h"
#include "viewer/app/display_windows.h"
#include "viewer/app/layout.h"
#include "viewer/app/panel_contents.h"
#include "viewer/app/pose_at.h"
#include "viewer/app/present_thread.h"
#include "viewer/app/surfaces_scale.h"
#include "viewer/app/user_body.h"
#include "viewer/app/user_tracking.h"
#include "viewer/app/view_core.h"
#include "viewer/app/wands.h"
#include "viewer/devices/gl/gamepads.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/displays/compose.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/component_wise.hpp>
#include <imgui.h>

namespace viewer {
namespace {

constexpr double kLook_s = 0.004;       // between two reads of input and sockets
constexpr double kPresentation_Hz = 60; // rate of reprojecting an old picture,
constexpr double kDrawings = 5;         // at most 1/5 of the time, as software drivers slow the renderer
constexpr double kFlicker_Hz = 2, kMessages_Hz = 12, kFades_Hz = 30, kMessage_s = 5;

class WindowLoop {
public:
    WindowLoop(ViewOptions const& options, FrameLink* link, gi::Report& report)
        : options_(with_surfaces(options)),
          core_(options_, report),
          state_(core_.state),
          link_(link),
          bodies_(options.avatars)
    {
        if (options.display) {
            if (!follows()) tracking_.emplace(*core_.display);
            if (!follows()) wands_.emplace(*core_.display, core_.options.rank);
            shown_ =
                open_windows(*core_.display, core_.options.rank, core_.options.swap_interval, core_.report,
                             [this](ShownWindow& w) { w.show_loading(core_.options.scene, PanelInput::none); });
        } else {
            open_desktop();
        }
        for (auto const& w : shown_.windows) {
            w->window.gl().make_current();
            if (options_.hash_shown) w->pictures().views().hash_pictures();
            w->window.gl().release(); // to the presenting thread
        }
        if (shown_.windows.empty())
            core_.requests.no_picture("this process has no window, those of the display belong to other ranks");
        std::function<std::vector<ViewCommand>(FrameCommand const&)> own;
        if (link != nullptr) own = [this](FrameCommand const& command) { return own_views(command.views); };
        if (link != nullptr) link->wake_by([] { glfwPostEmptyEvent(); });
        core_.start(
            link, [this] { return pixels_of_a_frame(); }, [] { glfwPostEmptyEvent(); }, own);
    }

    /// Radiance 1 becomes the display's white; without a model values are sRGB.
    static DisplayLight light_of(ViewOptions const& options)
    {
        if (!options.display_model || !options.display_model->luminance) return {};
        study::DisplayLuminance const& display = *options.display_model->luminance;
        return display_light(display, make_inverse_table(display), {});
    }

    ViewRunSummary run(gi::StopRequest const& stop)
    {
        double last = state_.clock.now_s();
        while (core_.poll(stop)) {
            wait_for_windows(kLook_s);
            double const now = state_.clock.now_s();
            take_input();
            if (follows())
                note_sizes();
            else
                look(now - last);
            last = now;
            show();
        }
        presenting_.reset();
        core_.finish();
        core_.summary.gl = shown_.windows.empty() ? "" : shown_.windows[0]->window.gl().description();
        if (tracking_) core_.summary.trackers = tracking_->stats(steady_now_s());
        return core_.summary;
    }

private:
    bool follows() const { return state_.follows; }

    /// Those that this process shows.
    std::vector<ViewCommand> own_views(std::vector<ViewCommand> const& all) const
    {
        return link_ != nullptr && core_.display ? views_of_rank(*core_.display, all, core_.options.rank) : all;
    }

    static std::vector<gi::Camera> cameras_of(std::vector<ViewCommand> const& views)
    {
        std::vector<gi::Camera> cameras;
        for (ViewCommand const& v : views) cameras.push_back(v.camera);
        return cameras;
    }

    void open_desktop()
    {
        bool const two = state_.settings().stereo == name_of(StereoMode::two_windows);
        WindowSettings settings;
        settings.title = "Lightwell: " + core_.options.scene;
        settings.size_px = core_.options.size_px;
        settings.swap_interval = core_.options.swap_interval;
        if (state_.settings().stereo == name_of(StereoMode::quad_buffer))
            settings.quad_buffer = QuadBuffer::wanted;
        std::string const scene = settings.title;
        std::size_t const windows = two ? 2 : 1;
        std::vector<std::string> const& monitors = core_.options.monitors;
        if (!monitors.empty() && monitors.size() != windows)
            throw gi::InputError(fmt::format("{} monitors for {} windows", monitors.size(), windows),
                                 "each window fills one", two ? "--fullscreen LEFT,RIGHT" : "name one");
        for (std::size_t i = 0; i < windows; ++i) {
            if (!monitors.empty()) settings.monitor = monitors[i];
            if (two) settings.title = scene + (i == 0 ? " (left eye)" : " (right eye)");
            if (i == 1 && monitors.empty()) {
                Window const& left = shown_.windows[0]->window;
                settings.position_px = left.position_px() + glm::ivec2(left.framebuffer_px().x, 0);
            }
            shown_.windows.push_back(
                std::make_unique<ShownWindow>(settings, std::vector<WallSettings>{}, core_.report));
            if (i == 0) shown_.windows[0]->show_loading(core_.options.scene, PanelInput::taken);
        }
        state_.has_two_windows = two;
        panel_ = shown_.windows[0]->panel.get();
        core_.keeps_recent = true;
    }

    /// Number of pixels of all views of this process, at full size.
    double pixels_of_a_frame()
    {
        if (core_.display) {
            double sum = 0;
            for (auto const& w : shown_.windows) sum += glm::compMul(glm::dvec2(w->window.framebuffer_px()));
            return sum;
        }
        return glm::compMul(eye_px()) * (possible_mode() == StereoMode::off ? 1 : 2);
    }

    void take_input()
    {
        for (std::size_t w = 0; w < shown_.windows.size(); ++w) {
            std::vector<InputEvent> events = shown_.windows[w]->window.take_events();
            if (w == 0) gamepads_.poll(events);
            if (panel_ && w == 0 && uses_panel()) panel_->claim(events);
            if (!events.empty()) dirty_ = 2; // what ImGui folds, it shows one picture later
            for (InputEvent const& e : events) {
                core_.controls.take(e, height_px());
                if (e.kind == InputKind::drop && !follows()) state_.open_scene(e.text);
            }
        }
        for (CommandEvent const& c : core_.controls.commands()) {
            dirty_ = std::max(dirty_, 1);
            core_.obey(c.command);
            if (c.command == Command::select) select({c.x, c.y});
            if (c.command == Command::drag) drag({c.x, c.y});
        }
        int const mode = core_.controls.stereo_mode();
        if (mode < 0 || core_.display) return;
        try {
            state_.change({"stereo", name_of(kStereoModes[std::size_t(mode) % std::size(kStereoModes)])});
        } catch (gi::InputError const& e) {
            state_.message = e.what();
        }
    }

    glm::ivec2 first_px() const
    {
        return shown_.windows.empty() ? glm::ivec2(0) : shown_.windows[0]->window.framebuffer_px();
    }
    double height_px() const { return std::max(1, first_px().y); }

    /// Size of one eye's picture in the window.
    glm::dvec2 eye_px()
    {
        StereoMode const mode = core_.display ? StereoMode::off : possible_mode();
        return glm::max(glm::dvec2(eye_size(mode, first_px())), glm::dvec2(1));
    }
    double aspect() const { return std::max(1, first_px().x) / height_px(); }

    void select(glm::dvec2 at_px)
    {
        glm::dvec2 const px = eye_px();
        state_.pick(glm::mod(at_px, px) / px, aspect(), [this](std::optional<Selection> const& found) {
            state_.selection = found;
            if (found) state_.navigation.set_pivot(found->picked.position);
            dirty_ = std::max(dirty_, 1);
        });
    }

    /// Moves along the picture plane, so that the picked point stays under the mouse.
    void drag(glm::dvec2 by_px)
    {
        if (!state_.selection) return;
        gi::dmat4 const m = state_.navigation.world_from_camera();
        double const depth = glm::dot(state_.selection->picked.position - gi::dvec3(m[3]), -gi::dvec3(m[2]));
        double const height_m = 2 * depth * std::tan(0.5 * state_.camera.yfov_rad);
        glm::dvec2 const by_m = by_px * height_m * glm::dvec2(aspect(), 1) / eye_px();
        state_.move_selection(by_m.x * gi::dvec3(m[0]) - by_m.y * gi::dvec3(m[1]));
    }

    /// Falls back to side by side if the windows have no quad buffers.
    StereoMode possible_mode()
    {
        StereoMode const mode = *stereo_mode(state_.settings().stereo);
        if (mode != StereoMode::quad_buffer || shown_.windows[0]->window.has_quad_buffer()) return mode;
        if (!std::exchange(fallback_told_, true)) {
            core_.report.lose("quad-buffer stereo not supported by this window: side by side instead");
            tell("quad-buffer stereo is not supported by this window (the driver has none) shown side by side");
        }
        return StereoMode::side_by_side;
    }

    std::vector<glm::ivec2> window_sizes() const
    {
        std::vector<glm::ivec2> sizes;
        for (auto const& w : shown_.windows) sizes.push_back(w->window.framebuffer_px());
        return sizes;
    }

    void note_sizes()
    {
        if (core_.display) viewer::note_sizes(*core_.display, shown_);
    }

    void set_panes(std::vector<std::vector<Pane>> const& panes)
    {
        for (std::size_t w = 0; w < panes.size(); ++w) {
            int const at = core_.display ? shown_.of[w] : int(w);
            if (at >= 0) shown_.windows[std::size_t(at)]->panes = panes[w];
        }
    }

    void look(double seconds)
    {
        NavigationInput in = core_.controls.motion(seconds);
        if (wands_ && wands_->any()) use_wands(seconds, in);
        state_.navigation.step(in, seconds);
        bodies_.step(core_.controls, seconds);
        Viewpoint at;
        at.pose_s = state_.clock.now_s();
        at.display_s = at.pose_s + expected_s_;
        note_sizes();
        Layout layout;
        if (core_.display) {
            Display const& display = *core_.display;
            // Of a picture that takes long, nobody can say where a head will be when it is seen.
            at.valid_s = at.pose_s + std::min(expected_s_, Anticipation::kFarthest_s);
            double const seen_s = state_.clock.to_steady(at.valid_s); // as trackers count
            // The resting head is at the navigation pose.
            at.world_from_room = state_.navigation.world_from_room() * glm::translate(gi::dmat4(1), -rest());
            at.tracked = tracking_->bodies(0, seen_s);
            bodies_.put(
                display, [&](std::size_t user) { return tracking_->bodies(user, seen_s); }, seconds, at);
            layout = display_layout(display, tracking_->heads(seen_s), at.world_from_room);
        } else {
            at.world_from_room = state_.navigation.world_from_camera();
            if (UserBody* const body = bodies_.first()) {
                gi::dmat4 const world_from_head = at.world_from_room;
                at.world_from_room = state_.navigation.world_from_room() *
                                     glm::translate(gi::dmat4(1), gi::dvec3{0, -core_.options.eye_height_m, 0});
                at.tracked = body->before_desktop(glm::inverse(at.world_from_room) * world_from_head);
                body->stand(at.tracked, at.world_from_room, seconds);
            }
            layout = desktop_layout(state_, possible_mode(), window_sizes());
        }
        at.views = std::move(layout.views);
        at.jump = state_.navigation.jump();
        bool const can_draw = link_ != nullptr ? link_->shown_state().draws_surfaces : draws_surfaces_;
        if (can_draw && !state_.wants_screenshot && !core_.requests.wants_bytes() && state_.settings().reproject &&
            (link_ != nullptr || !shown_.windows.empty()))
            at.drawn_scale = surfaces_scale_.next();
        anticipation_.see(at);
        cameras_ = cameras_of(at.views);
        if (link_ == nullptr) set_panes(layout.panes);
        core_.look(std::move(at));
    }

    void use_wands(double seconds, NavigationInput& in)
    {
        // The resting head is at the navigation pose.
        gi::dmat4 const world_from_room =
            state_.navigation.world_from_room() * glm::translate(gi::dmat4(1), -rest());
        NavigationInput const by_wands =
            wands_->step(tracking_->wands(steady_now_s()), core_, world_from_room, seconds);
        in.right += by_wands.right;
        in.up += by_wands.up;
        in.forward += by_wands.forward;
        in.turn_right_rad += by_wands.turn_right_rad;
        if (wands_->wants_picture(state_.clock.now_s())) dirty_ = std::max(dirty_, 1);
    }

    /// Now, as trackers count.
    double steady_now_s() const { return state_.clock.to_steady(state_.clock.now_s()); }

    /// Resting pose of the first user's head, in the room.
    gi::dvec3 rest() const
    {
        return core_.display->users.empty() ? gi::dvec3{0} : resting_head(core_.display->users[0]).position;
    }

    bool has_moved() const { return cameras_.size() == shown_cameras_.size() && !(cameras_ == shown_cameras_); }

    /// The user works with panel or dialog.
    bool uses_panel() const { return state_.settings().panel || state_.open_dialog.is_open(); }

    /// At once, in the window and on stderr.
    void tell(std::string const& what)
    {
        state_.message = what;
        std::fputs(("note: " + what + "\n").c_str(), stderr);
    }

    /// True if something besides the panel is drawn over the picture. A new message stays for a while.
    bool has_messages()
    {
        if (state_.message != message_) {
            message_ = state_.message;
            message_until_s_ = state_.clock.now_s() + kMessage_s;
        }
        bool const is_new = !message_.empty() && state_.clock.now_s() < message_until_s_;
        return state_.loading || state_.building || is_new || state_.shows_help || state_.open_dialog.is_open();
    }

    bool in_software() const { return !shown_.windows.empty() && shown_.windows[0]->window.gl().is_software(); }

    /// Surfaces that would be drawn now were drawn last.
    bool shows(LiveFrame const& frame) const
    {
        if (!drawn_moment_ || has_moved()) return false;
        double const now_s = state_.clock.now_s();
        return look_same(frame, *drawn_moment_,
                         moment_at(frame, expected(now_s), now_s + ahead_s(), core_.renderer->edits_since(frame)));
    }

    void show()
    {
        if (presenting_->busy()) return;
        auto const next = link_ != nullptr && follows() ? link_->next_shown() : std::nullopt;
        auto newest = follows() ? state_.frame : core_.renderer->newest();
        if (next) {
            last_shown_ = next;
            if (auto const frame = core_.renderer->frame(next->moment.frame)) newest = frame;
        }
        double const since_s = state_.clock.now_s() - last_swap_s_;
        bool const fresh = newest != state_.frame;
        double const pause_s =
            newest ? drawing_pause_s(core_.renderer->edits_since(*newest), in_software(), surfaces_s_) : 0;
        bool const moved = !follows() && state_.settings().reproject && newest &&
                           (has_moved() || (newest->command.only_light && !shows(*newest))) &&
                           since_s > std::max({1 / kPresentation_Hz, kDrawings * draw_s_, pause_s});
        bool const fades = !follows() && fades_ && since_s > std::max(1 / kFades_Hz, pause_s);
        bool const draws = prepares_ && since_s > 1 / kMessages_Hz;
        bool const flickers = state_.settings().view == "flicker" && since_s > 0.5 / kFlicker_Hz;
        bool const resized = std::any_of(shown_.windows.begin(), shown_.windows.end(),
                                         [](auto const& w) { return w->window.framebuffer_px() != w->shown_px; });
        bool const messages = has_messages();
        bool const tells = messages != had_messages_ || (messages && since_s > 1 / kMessages_Hz);
        if (next || fresh || moved || fades || draws || flickers || dirty_ > 0 || resized || tells ||
            state_.wants_screenshot)
            present(newest, fresh, next ? next->number : 0);
    }

    /// Data passed to the presenting thread and back.
    struct Presentation {
        std::shared_ptr<LiveFrame const> frame;
        std::optional<ShownMoment> moment; ///< with the views of all ranks
        std::uint64_t number = 0;          ///< with which other ranks show the same moment; 0 = they do not
        std::string not_shown;             ///< why others do not show it although they should
        std::optional<ShownFrame> shown;   ///< for a recording
        bool fresh = false, panel = false, messages = false, wants_bytes = false, reprojected = false;
        bool surfaces = false, prepares = false; ///< drawn; or about to be
        bool fades = false;
        bool can_draw = true;                    ///< surfaces of all views
        std::string why_no_surfaces;
        PresentSettings settings;
        std::vector<gi::Camera> cameras;
        std::vector<glm::ivec2> sizes;
        double begun_s = 0;
        FrameTimes times;
        SwapTime swap;
        double shown_s = 0;
        std::vector<Snapshot> shots; ///< per window or eye of a window
    };

    /// From the start of a picture to the middle of the time for which it is shown.
    double ahead_s() const
    {
        return state_.settings().predict ? std::min(1.5 * surfaces_s_, Anticipation::kFarthest_s) : 0;
    }

    /// The moment in which a frame is shown by a picture that is begun now.
    ShownMoment moment_of(LiveFrame const& frame, double begun_s, double surfaces_scale)
    {
        std::vector<ViewCommand> const& views = frame.ordered.empty() ? frame.command.views : frame.ordered;
        Viewpoint const at = expected(begun_s);
        std::vector<gi::Camera> const rendered = cameras_of(views);
        bool const reprojects = state_.settings().reproject && cameras_.size() == rendered.size();
        if (reprojects && state_.settings().draw_surfaces) cameras_ = cameras_of(at.views);
        shown_cameras_ = reprojects ? cameras_ : rendered;
        ShownMoment shown{moment_at(frame, at, begun_s + ahead_s(), core_.renderer->edits_since(frame)),
                          surfaces_scale, 0};
        for (std::size_t k = 0; k < shown_cameras_.size(); ++k) shown.moment.views[k].camera = shown_cameras_[k];
        return shown;
    }

    /// @param number  of the leader's moment that is shown; 0 = none
    void present(std::shared_ptr<LiveFrame const> const& newest, bool fresh, std::uint64_t number)
    {
        dirty_ = std::max(0, dirty_ - 1);
        state_.drawing = true;
        auto const p = std::make_shared<Presentation>();
        p->frame = newest;
        p->fresh = fresh;
        p->number = number;
        p->begun_s = state_.clock.now_s();
        if (newest && state_.wants_screenshot && !newest->command.only_light) // its picture is saved, too
            p->wants_bytes = std::exchange(state_.wants_screenshot, false);
        if (fresh) {
            state_.frame = newest;
            state_.follow(newest->settings);
            meter_.see(newest);
            if (!follows()) core_.expose(*newest);
        }
        p->settings = present_settings();
        if (newest && follows())
            p->moment = last_shown_;
        else if (newest)
            p->moment = moment_of(*newest, p->begun_s, p->settings.surfaces_scale);
        if (p->moment) {
            p->settings.moment_number = p->moment->number; // 0 on the leader: the link gives it
            p->settings.surfaces_scale = p->moment->surfaces_scale;
            p->settings.moment = p->moment->moment;
            p->settings.moment->views = own_views(p->moment->moment.views);
            p->cameras = cameras_of(p->settings.moment->views);
            drawn_moment_ = p->moment->moment;
            p->reprojected = !(p->cameras == cameras_of(newest->command.views)) || newest->command.only_light;
            if (link_ != nullptr && core_.display)
                set_panes(
                    display_panes(*core_.display, p->settings.moment->views, p->settings.moment->world_from_room));
        }
        p->settings.fades = !p->wants_bytes && state_.settings().compare.empty();
        state_.live_error = meter_.latest();
        for (auto const& w : shown_.windows) {
            w->shown_px = w->window.framebuffer_px();
            w->shown_panes = w->panes;
            w->on_screen_px = w->window.position_px();
        }
        p->panel = panel_ && state_.settings().panel && newest;
        p->messages = had_messages_ = has_messages();
        if (p->panel || p->messages)
            for (auto const& w : shown_.windows) fill(*w, *p);
        if (wands_) wands_->prepare(state_, frames_per_s_, p->begun_s);
        presenting_->start([this, p] { draw(*p); },
                           [this, p] {
                               state_.inbox.put([this, p] { presented(*p); });
                               glfwPostEmptyEvent();
                           });
    }

    void fill(ShownWindow& w, Presentation const& p)
    {
        if (!w.panel) return;
        w.panel->begin();
        ImGui::GetIO().FontGlobalScale = float(state_.settings().font_scale);
        if (p.panel && w.panel.get() == panel_) fill_panel(state_, frames_per_s_, PanelPlace::over_picture);
        if (state_.loading)
            fill_loading(*state_.loading, p.frame ? LoadingPlace::over_picture : LoadingPlace::alone);
        else if (state_.building)
            fill_building(*state_.building);
        if (w.panel.get() == panel_)
            if (auto const scene = state_.open_dialog.draw()) state_.open_scene(*scene);
        if (state_.shows_help) fill_help(key_meanings());
        if (!message_.empty() && state_.clock.now_s() < message_until_s_ && !(p.panel && w.panel.get() == panel_))
            fill_message(message_);
        w.panel->finish();
    }

    static void shoot(DrawTarget const& window, std::vector<Snapshot>& shots)
    {
        shots.push_back({window.size_px, read_bytes(window, window.left_buffer)});
        if (window.right_buffer != 0) shots.push_back({window.size_px, read_bytes(window, window.right_buffer)});
    }

    /// Called on the presenting thread.
    void draw(Presentation& p)
    {
        if (link_ != nullptr && !follows() && p.moment) {
            try {
                p.settings.moment_number = p.number = link_->show(*p.moment);
            } catch (gi::InputError const& e) {
                p.not_shown = e.what();
            }
        }
        for (std::size_t w = 0; w < shown_.windows.size(); ++w) {
            ShownWindow& shown = *shown_.windows[w];
            shown.window.gl().make_current();
            double const from = state_.clock.now_s();
            if (w == 0 && wands_) p.settings.overlay = wands_->draw(shown.window.gl());
            if (p.fresh) shown.pictures().take(p.frame, shown.shown_panes);
            double const uploaded = state_.clock.now_s();
            clear(target_of(shown.window));
            if (p.frame)
                shown.pictures().draw(target_of(shown.window), shown.on_screen_px, shown.shown_panes, p.settings,
                                      p.cameras);
            p.surfaces |= shown.pictures().views().drew_surfaces();
            p.prepares |= shown.pictures().views().prepares();
            p.fades |= shown.pictures().fades();
            p.can_draw &= shown.pictures().views().draws_surfaces();
            p.why_no_surfaces = shown.pictures().views().why_no_surfaces();
            if (p.wants_bytes) shoot(target_of(shown.window), p.shots);
            if (shown.panel && (p.messages || p.panel)) shown.panel->draw();
            p.times.upload_ms += 1e3 * (uploaded - from);
            p.times.draw_ms += 1e3 * (state_.clock.now_s() - uploaded);
        }
        if (p.moment) {
            std::vector<ShownViews const*> views;
            for (auto const& w : shown_.windows) views.push_back(&w->pictures().views());
            p.shown = ShownFrame{p.moment->moment, p.moment->surfaces_scale, {}};
            if (!views.empty()) p.shown = shown_frame(p.moment->moment, views);
            if (link_ != nullptr) p.shown->pixel_hash.reset(); // no rank has all views
        }
        p.swap.time = SwapTime::Clock::now();
        if (p.number > 0) {
            for (auto const& w : shown_.windows) { // wait until drawing has finished
                w->window.gl().make_current();
                glFinish();
            }
            link_->drawn(p.number, {p.can_draw, p.fades});
        }
        for (auto const& w : shown_.windows) {
            w->window.gl().make_current();
            p.swap = w->timer.swap();
        }
        for (auto const& w : shown_.windows) w->window.gl().release();
        p.shown_s = state_.clock.at_s(p.swap.time);
    }

    void presented(Presentation const& p)
    {
        prepares_ = p.prepares;
        fades_ = p.number > 0 ? link_->shown_state().fades : p.fades;
        draws_surfaces_ = p.can_draw;
        if (!p.why_no_surfaces.empty() && !std::exchange(no_surfaces_told_, true)) {
            core_.report.lose("surfaces not drawn, pictures are reprojected", 1, p.why_no_surfaces);
            tell("surfaces are not drawn for newer poses (" + p.why_no_surfaces +
                 ") pictures are reprojected instead");
        }
        if (p.surfaces) {
            surfaces_scale_.measured(p.settings.surfaces_scale, p.shown_s - p.begun_s);
            surfaces_s_ = surfaces_s_ > 0 ? surfaces_s_ + 0.2 * (p.shown_s - p.begun_s - surfaces_s_)
                                          : p.shown_s - p.begun_s;
        }
        if (p.reprojected) draw_s_ = p.surfaces ? 0 : 1e-3 * p.times.draw_ms;
        Snapshot const shot = p.shots.empty() ? Snapshot{} : side_by_side(p.shots);
        if (!shot.empty() && std::exchange(state_.own_screenshot, false)) core_.save_screenshot(shot);
        state_.drawing = false;
        core_.requests.presented(p.shown_s, shot);
        if (core_.requests.wants_bytes()) state_.wants_screenshot = true;
        ++core_.summary.presented;
        if (!p.not_shown.empty()) core_.report.lose("pictures that other ranks did not show", 1, p.not_shown);
        if (p.number > 0) link_->swapped(p.number, state_.clock.to_steady(p.shown_s));
        if (p.shown) {
            ShownFrame shown = *p.shown;
            shown.moment.display_s = p.shown_s;
            core_.note_shown(shown);
        }
        if (p.fresh) log(*p.frame, p.times, p.swap, p.begun_s, p.shown_s, p.reprojected);
        last_swap_s_ = p.shown_s;
    }

    void log(LiveFrame const& f, FrameTimes times, SwapTime const& swap, double begun, double shown_s,
             bool reprojected)
    {
        expected_s_ = (f.done_s - f.begun_s) + (shown_s - begun);
        times.frame = f.command.frame;
        times.pose_s = f.command.pose_s;
        times.display_s = f.command.display_s;
        times.swap_s = shown_s;
        times.swap_method = swap.method == GlSwapMethod::sync_control ? SwapMethod::oml : SwapMethod::fence;
        times.swap_uncertainty_ms = swap.uncertainty_ms;
        times.wait_ms = 1e3 * (begun - f.done_s);
        times.render_ms = 1e3 * (f.done_s - f.begun_s);
        times.paths = f.command.paths;
        if (!f.command.views.empty()) {
            times.width = f.command.views[0].width;
            times.height = f.command.views[0].height;
        }
        // While nothing moves, frames have no due time.
        bool const due = f.result.still_frames <= 1 && last_fresh_s_ > 0;
        times.dropped =
            due ? std::max(0, int(std::floor((shown_s - last_fresh_s_) * f.settings.rate_hz - 0.5))) : 0;
        times.late_ms = 1e3 * (shown_s - f.command.display_s);
        times.reprojected = reprojected;
        if (tracking_) times.tracker_ms = tracking_->age_ms(steady_now_s());
        core_.log(times);
        if (last_fresh_s_ > 0) frames_per_s_ = 0.8 * frames_per_s_ + 0.2 / std::max(1e-4, shown_s - last_fresh_s_);
        last_fresh_s_ = shown_s;
    }

    /// Where the users will be in the middle of the time for which a picture that is begun now is shown.
    Viewpoint expected(double now_s) const
    {
        return anticipation_.at(now_s, now_s + (state_.settings().predict ? 1.5 * surfaces_s_ : 0));
    }

    PresentSettings present_settings() const
    {
        // Other ranks know those of the frame alone.
        Settings const& s = link_ != nullptr && state_.frame ? state_.frame->settings : state_.settings();
        PresentSettings p;
        p.tone = tone_settings(s);
        p.light = light_;
        p.split = float(s.split);
        p.swap_eyes = s.swap_eyes;
        if (s.draw_surfaces) {
            p.surfaces_scale = surfaces_scale_.next();
            p.drive = core_.options.drive;
        }
        if (s.compare.empty()) return p;
        bool const second = std::fmod(state_.clock.now_s() * kFlicker_Hz, 1.0) < 0.5;
        p.comparison = s.view == "split"               ? Comparison::split
                       : s.view == "difference"        ? Comparison::difference
                       : s.view == "flicker" && second ? Comparison::other
                                                       : Comparison::off;
        return p;
    }

    ViewOptions const options_;
    ViewCore core_;
    DisplayLight const light_ = light_of(core_.options);
    ViewState& state_;
    FrameLink* link_;
    UserBodies bodies_;
    std::optional<UserTracking> tracking_;
    Gamepads gamepads_;
    DisplayWindows shown_;
    std::optional<Wands> wands_; ///< of a display, not on ranks that follow
    Panel* panel_ = nullptr;     ///< of the first window, for the user; not on the walls of a display
    std::unique_ptr<PresentThread> presenting_ = std::make_unique<PresentThread>();
    ErrorMeter meter_;
    Anticipation anticipation_;
    std::vector<gi::Camera> cameras_, shown_cameras_; ///< of all views: current, and as shown
    std::optional<FrameCommand> drawn_moment_;        ///< of the last picture
    std::optional<ShownMoment> last_shown_;           ///< that the leader showed, on a rank that follows
    int dirty_ = 1; ///< pictures that are to be shown although nothing else changed
    bool fallback_told_ = false, no_surfaces_told_ = false, had_messages_ = false;
    std::string message_; ///< the last message, shown until message_until_s_
    double message_until_s_ = 0;
    double last_swap_s_ = 0, last_fresh_s_ = 0, expected_s_ = 0, frames_per_s_ = 0;
    double draw_s_ = 0; ///< that the last reprojected picture took
    SurfacesScale surfaces_scale_;
    double surfaces_s_ = 0; ///< from the start of a picture whose surfaces are drawn until it is shown, smoothed
    bool draws_surfaces_ = false; ///< pictures may be of light alone
    bool fades_ = false;          ///< a picture or its light fades in: it is to be drawn again soon
    bool prepares_ = false;       ///< surfaces will be drawn when more of the scene is on the GPU
};

} // namespace

ViewRunSummary run_view(ViewOptions const& options, FrameLink* link, gi::StopRequest const& stop,
                        gi::Report& report)
{
    return WindowLoop(options, link, report).run(stop);
}

} // namespace viewer
