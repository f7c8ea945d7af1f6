#include "viewer/show/view_program.h"

#include "gi/base/error.h"
#include "gi/base/picture_file.h"
#include "viewer/live/desktop_views.h"
#include "viewer/recording/pixel_hash.h"
#include "viewer/show/panel_contents.h"
#include "viewer/show/requests.h"
#include "viewer/stereo/compose.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr double kLook_s = 0.004;       // between two looks at input and sockets
constexpr double kPresentation_Hz = 60; // of old pictures seen from new places
constexpr double kFlicker_Hz = 2;

std::uint64_t hash_of(LiveFrame const& frame)
{
    std::uint64_t hash = 0;
    for (ViewPicture const& v : frame.result.views)
        hash = pixel_hash(std::as_bytes(std::span(v.picture.find("color")->data)), hash);
    return hash;
}

nlohmann::json all_settings(Settings const& s)
{
    nlohmann::json j = nlohmann::json::object();
    for (SettingKey const& k : setting_keys()) j[k.key] = get(s, k.key);
    return j;
}

class ViewLoop {
public:
    ViewLoop(ViewOptions const& options, gi::Report& report)
        : options_(options),
          report_(report),
          session_(options.load, options.threads, report),
          window_({.title = "Lightwell: " + options.scene,
                   .size_px = options.size_px,
                   .position_px = {},
                   .monitor = options.monitor,
                   .swap_interval = options.swap_interval,
                   .quad_buffer = wants_quad(options) ? QuadBuffer::wanted : QuadBuffer::no,
                   .visibility = Visibility::shown},
                  report),
          presenter_(window_, {}),
          timer_(window_, report),
          requests_(state_, controls_, report)
    {
        begin_session();
        open_files();
        start_renderer();
        if (!options.remote.socket.empty() || options.remote.port) {
            remote_ = std::make_unique<RemoteServer>(
                options.remote, [this](RemoteRequest const& r) { return requests_.handle(r); }, report);
            requests_.answer_with(remote_.get());
        }
    }

    ViewSummary run(gi::StopRequest const& stop)
    {
        double last = state_.clock.now_s();
        while (!state_.ends && !stop.requested() && !renderer_->stopped()) {
            wait_for_windows(kLook_s);
            double const now = state_.clock.now_s();
            summary_.longest_block_ms = std::max(summary_.longest_block_ms, 1e3 * (now - last - kLook_s));
            if (options_.time_limit_s > 0 && now > options_.time_limit_s) break;
            state_.inbox.read();
            requests_.step();
            if (remote_) remote_->poll();
            take_input();
            move(now - last);
            last = now;
            show();
        }
        renderer_->stop();
        if (recorder_) recorder_->finish();
        if (log_) {
            log_->close();
            summary_.frames = log_->summary();
        }
        summary_.recorded = recorder_ ? recorder_->frames() : 0;
        summary_.gl = window_.gl().description();
        return summary_;
    }

private:
    static bool wants_quad(ViewOptions const& o)
    {
        return std::any_of(o.settings.begin(), o.settings.end(), [](Change const& c) {
            return c.key == "stereo" && c.value == name_of(StereoMode::quad_buffer);
        });
    }

    void begin_session()
    {
        for (Change const& c : options_.settings) session_.apply(c);
        session_.apply({"scene", options_.scene});
        state_.settings = session_.settings();
        state_.facts = facts_of(session_);
        start_at(options_.first_camera(session_.world()));
        state_.navigation.set_mode(options_.navigation);
    }

    void start_at(gi::Camera const& camera)
    {
        state_.first_camera = state_.camera = camera;
        // A walk through a room takes seconds, whatever its size.
        double const speed = std::clamp(0.2 * state_.facts.radius_m, 0.05, 20.0);
        state_.navigation = Navigation(camera.world_from_camera, speed, state_.facts.center);
        gi::dvec3 const middle(camera.world_from_camera[3]);
        state_.screen_distance_m = std::clamp(glm::length(state_.facts.center - middle), 0.2, 1e4);
    }

    void open_files()
    {
        if (!options_.record.empty()) {
            RecordingHeader header = options_.header;
            header.scene = options_.scene;
            header.settings = {{"settings", all_settings(state_.settings)}, {"load", options_.load_options}};
            recorder_ = std::make_unique<Recorder>(options_.record, header, report_);
        }
        if (!options_.frame_log.empty())
            log_ = std::make_unique<FrameLog>(
                options_.frame_log, options_.header.program + "\n" + options_.header.command_line, report_);
    }

    void start_renderer()
    {
        LiveRenderer::Hooks hooks;
        hooks.finished = [this](LiveFrame const& f) {
            ++summary_.rendered;
            if (recorder_) recorder_->append({f.order, hash_of(f), {}});
        };
        hooks.published = [] { glfwPostEmptyEvent(); };
        hooks.failed = [this](std::string const& why) {
            report_.lose("frames that could not be rendered", 1, why);
            state_.inbox.put([this, why] { state_.message = why; });
        };
        renderer_ = std::make_unique<LiveRenderer>(session_, state_.clock, nullptr, hooks);
        state_.renderer = renderer_.get();
    }

    void take_input()
    {
        double const height = std::max(1, window_.framebuffer_px().y);
        std::vector<InputEvent> events = window_.take_events();
        if (panel_) panel_->claim(events);
        if (!events.empty()) dirty_ = true;
        for (InputEvent const& e : events) controls_.take(e, height);
        for (CommandEvent const& c : controls_.commands()) command(c);
        if (int const mode = controls_.stereo_mode(); mode >= 0)
            state_.change({"stereo", name_of(kStereoModes[std::size_t(mode) % std::size(kStereoModes)])});
    }

    void command(CommandEvent const& c)
    {
        Settings const& s = state_.settings;
        auto const next = [](std::vector<std::string> const& words, std::string const& now) {
            auto const at = std::find(words.begin(), words.end(), now);
            return at == words.end() || at + 1 == words.end() ? words.front() : *(at + 1);
        };
        switch (c.command) {
        case Command::close:
            state_.ends = true;
            break;
        case Command::panel:
            state_.change({"panel", !s.panel});
            break;
        case Command::screenshot:
            state_.wants_screenshot = own_screenshot_ = true;
            break;
        case Command::swap_eyes:
            state_.change({"swap_eyes", !s.swap_eyes});
            break;
        case Command::next_navigation:
            state_.navigation.set_mode(NavigationMode((int(state_.navigation.mode()) + 1) % 3));
            break;
        case Command::first_camera:
            state_.navigation.go_to(state_.first_camera.world_from_camera);
            break;
        case Command::next_view:
            state_.change({"view", next({"picture", "split", "flicker", "difference"}, s.view)});
            break;
        case Command::compare:
            state_.change({"compare", s.compare.empty() ? "reference" : ""});
            state_.change({"view", s.compare.empty() ? "picture" : "split"});
            break;
        case Command::next_method:
            state_.change({"method", next({"slhb", "reference"}, s.method)});
            break;
        case Command::brighter:
            state_.change({"exposure", std::min(32.0, s.exposure_ev + 0.25)});
            break;
        case Command::darker:
            state_.change({"exposure", std::max(-32.0, s.exposure_ev - 0.25)});
            break;
        case Command::play:
            state_.change({"play", !s.play});
            break;
        case Command::reproject:
            state_.change({"reproject", !s.reproject});
            break;
        case Command::select:
            select({c.x, c.y});
            break;
        case Command::drag:
            drag({c.x, c.y});
            break;
        }
        dirty_ = true;
    }

    double aspect() const
    {
        glm::ivec2 const px = window_.framebuffer_px();
        return double(std::max(1, px.x)) / std::max(1, px.y);
    }

    void select(glm::dvec2 at_px)
    {
        glm::dvec2 const px(window_.framebuffer_px());
        state_.pick(at_px / glm::max(px, glm::dvec2(1)), aspect(), [this](std::optional<Selection> const& found) {
            state_.selection = found;
            if (found) state_.navigation.set_pivot(found->picked.position);
            dirty_ = true;
        });
    }

    /// Along the picture plane, so that the place that was picked stays under the mouse.
    void drag(glm::dvec2 by_px)
    {
        if (!state_.selection) return;
        double const height = std::max(1, window_.framebuffer_px().y);
        gi::dmat4 const m = state_.navigation.world_from_camera();
        double const depth = glm::dot(state_.selection->picked.position - gi::dvec3(m[3]), -gi::dvec3(m[2]));
        double const m_per_px = 2 * depth * std::tan(0.5 * state_.camera.yfov_rad) / height;
        gi::dvec3 const by = m_per_px * (by_px.x * gi::dvec3(m[0]) - by_px.y * gi::dvec3(m[1]));
        state_.selection->picked.position += by;
        std::string const object = state_.selection->object;
        renderer_->ask([this, object, by](Session& s) {
            try {
                gi::dvec3 const at = s.position_of(object) + by;
                Change const moved{"object." + object + ".position", {at.x, at.y, at.z}};
                state_.inbox.put([this, moved] { state_.change(moved); });
            } catch (gi::InputError const& e) {
                state_.inbox.put([this, why = std::string(e.what())] { state_.message = why; });
            }
        });
    }

    void move(double seconds)
    {
        NavigationInput const in = controls_.motion(seconds);
        state_.navigation.step(in, seconds);
        glm::ivec2 const px = window_.framebuffer_px();
        StereoMode const mode = *stereo_mode(state_.settings.stereo);
        glm::ivec2 const eye_px = eye_size(mode, px);
        Viewpoint at;
        at.pose_s = state_.clock.now_s();
        at.display_s = at.pose_s + expected_s_;
        at.world_from_room = state_.navigation.world_from_camera();
        if (eye_px.x > 0 && eye_px.y > 0) // not minimised
            at.views = desktop_views(
                state_.now(), {mode != StereoMode::off, state_.settings.eye_distance_m, state_.screen_distance_m},
                eye_px.x, eye_px.y);
        cameras_.clear();
        for (ViewOrder const& v : at.views) cameras_.push_back(v.camera);
        panes_ = {{{0, 0}, px, mode, 0, at.views.size() > 1 ? 1 : -1}};
        renderer_->look(std::move(at));
    }

    bool has_moved() const
    {
        if (!state_.frame || cameras_.size() != state_.frame->order.views.size()) return false;
        for (std::size_t k = 0; k < cameras_.size(); ++k)
            if (!(cameras_[k] == shown_cameras_[k])) return true;
        return false;
    }

    void show()
    {
        auto const newest = renderer_->newest();
        if (!newest) return;
        double const now = state_.clock.now_s();
        bool const fresh = newest != state_.frame;
        bool const moved =
            state_.settings.reproject && !fresh && has_moved() && now - last_swap_s_ > 1 / kPresentation_Hz;
        bool const flickers = state_.settings.view == "flicker" && now - last_swap_s_ > 0.5 / kFlicker_Hz;
        bool const resized = window_.framebuffer_px() != shown_px_;
        if (!fresh && !moved && !flickers && !dirty_ && !resized && !state_.wants_screenshot) return;
        dirty_ = false;
        present(newest, fresh);
    }

    void present(std::shared_ptr<LiveFrame const> const& newest, bool fresh)
    {
        window_.gl().make_current();
        FrameTimes times;
        double const begun = state_.clock.now_s();
        if (fresh) {
            state_.frame = newest;
            presenter_.take(newest, panes_);
            meter_.see(newest);
            if (state_.facts.scene != loaded_) {
                loaded_ = state_.facts.scene;
            }
        }
        double const uploaded = state_.clock.now_s();
        state_.live_error = meter_.latest();
        bool const same = cameras_.size() == state_.frame->order.views.size();
        std::vector<gi::Camera> const as_rendered = [&] {
            std::vector<gi::Camera> all;
            for (ViewOrder const& v : state_.frame->order.views) all.push_back(v.camera);
            return all;
        }();
        std::vector<gi::Camera> const now = state_.settings.reproject && same ? cameras_ : as_rendered;
        presenter_.draw(panes_, present_settings(), now);
        shown_cameras_ = now;
        shown_px_ = window_.framebuffer_px();
        std::vector<unsigned char> bytes;
        if (state_.wants_screenshot) bytes = read_bytes(target_of(window_));
        draw_panel();
        double const drawn = state_.clock.now_s();
        SwapTime const swap = timer_.swap();
        double const shown = state_.clock.at_s(swap.time);
        if (std::exchange(own_screenshot_, false)) save_own(bytes);
        state_.wants_screenshot = false;
        requests_.presented(shown, shown_px_, bytes);
        if (requests_.wants_bytes()) state_.wants_screenshot = true;
        ++summary_.presented;
        if (fresh) {
            LiveFrame const& f = *newest;
            expected_s_ = (f.done_s - f.begun_s) + (drawn - begun);
            times.frame = f.order.frame;
            times.pose_s = f.order.pose_s;
            times.display_s = f.order.display_s;
            times.swap_s = shown;
            times.swap_method = swap.method == GlSwapMethod::sync_control ? SwapMethod::oml : SwapMethod::fence;
            times.swap_uncertainty_ms = swap.uncertainty_ms;
            times.wait_ms = 1e3 * (begun - f.done_s);
            times.render_ms = 1e3 * (f.done_s - f.begun_s);
            times.upload_ms = 1e3 * (uploaded - begun);
            times.draw_ms = 1e3 * (drawn - uploaded);
            times.paths = f.order.paths;
            times.width = f.order.views[0].width;
            times.height = f.order.views[0].height;
            double const period = 1 / f.settings.rate_hz;
            bool const due = f.result.still_frames <= 1 && last_fresh_s_ > 0;
            times.dropped = due ? std::max(0, int(std::floor((shown - last_fresh_s_) / period - 0.5))) : 0;
            times.late_ms = 1e3 * (shown - f.order.display_s);
            times.reprojected = !(now == as_rendered);
            if (times.dropped > 0) report_.lose("frames dropped", std::uint64_t(times.dropped));
            if (log_) log_->append(times);
            frames_per_s_ =
                last_fresh_s_ > 0 ? 0.8 * frames_per_s_ + 0.2 / std::max(1e-4, shown - last_fresh_s_) : 0;
            last_fresh_s_ = shown;
        }
        last_swap_s_ = shown;
    }

    PresentSettings present_settings() const
    {
        Settings const& s = state_.settings;
        PresentSettings p;
        p.tone = tone_settings(s);
        p.split = float(s.split);
        p.swap_eyes = s.swap_eyes;
        if (!s.compare.empty()) {
            bool const second = std::fmod(state_.clock.now_s() * kFlicker_Hz, 1.0) < 0.5;
            p.comparison = s.view == "split"               ? Comparison::split
                           : s.view == "difference"        ? Comparison::difference
                           : s.view == "flicker" && second ? Comparison::other
                                                           : Comparison::off;
        }
        return p;
    }

    void draw_panel()
    {
        if (!state_.settings.panel) {
            panel_.reset();
            return;
        }
        if (!panel_) panel_ = std::make_unique<Panel>(window_);
        panel_->begin();
        fill_panel(state_, frames_per_s_);
        panel_->end();
    }

    void save_own(std::vector<unsigned char> const& bytes)
    {
        std::string const base = fmt::format("{}lightwell_{:06}", options_.screenshots, state_.frame->order.frame);
        try {
            gi::write_png(base + ".png", shown_px_.x, shown_px_.y, bytes);
            gi::write_exr(base + ".exr", state_.frame->result.views[0].picture, gi::PixelType::single, report_);
            state_.message = "saved " + base + ".png and .exr";
        } catch (gi::InputError const& e) {
            state_.message = e.what();
        }
    }

    ViewOptions const& options_;
    gi::Report& report_;
    ViewState state_;
    Session session_;
    Window window_;
    Presenter presenter_;
    SwapTimer timer_;
    std::unique_ptr<Panel> panel_;
    Controls controls_;
    Requests requests_;
    ErrorMeter meter_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<FrameLog> log_;
    std::unique_ptr<LiveRenderer> renderer_;
    std::unique_ptr<RemoteServer> remote_;
    std::vector<Pane> panes_;
    std::vector<gi::Camera> cameras_, shown_cameras_; ///< of the views: now, and as shown
    glm::ivec2 shown_px_{};
    std::string loaded_;
    bool dirty_ = true, own_screenshot_ = false;
    double last_swap_s_ = 0, last_fresh_s_ = 0, expected_s_ = 0, frames_per_s_ = 0;
    ViewSummary summary_;
};

} // namespace

ViewSummary run_view(ViewOptions const& options, gi::StopRequest const& stop, gi::Report& report)
{
    return ViewLoop(options, report).run(stop);
}

} // namespace viewer
