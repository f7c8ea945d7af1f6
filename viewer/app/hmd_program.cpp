#include "viewer/app/hmd_program.h"

#include "gi/core/quantile.h"
#include "viewer/app/hmd_eyes.h"
#include "viewer/app/pose_at.h"
#include "viewer/app/surfaces_scale.h"
#include "viewer/app/user_body.h"
#include "viewer/app/view_core.h"
#include "viewer/devices/xr/keeper.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {
namespace {

constexpr char const* kEyes[] = {"left eye",
                                 "right eye"}; ///< names of their views; their middles are not rendered

WindowSettings hidden()
{
    WindowSettings settings;
    settings.size_px = {64, 64};
    settings.visibility = Visibility::hidden;
    return settings;
}

/// Pixels of both eyes assumed until the runtime reports their sizes; the method's start is planned for them.
constexpr double kEyesPixels = 2.0 * 1440 * 1600;

/// Compares bit by bit, so that NaN equals itself.
bool same(HiddenMask const& a, HiddenMask const& b)
{
    return a.triangles == b.triangles &&
           std::ranges::equal(std::as_bytes(std::span(a.points)), std::as_bytes(std::span(b.points)));
}

double quantile_or_0(std::vector<double> const& values, double p)
{
    return values.empty() ? 0 : gi::quantile(values, p);
}

class HmdLoop {
public:
    HmdLoop(ViewOptions const& options, HmdOptions const& headset, gi::Report& report)
        : options_(with_surfaces(options)),
          core_(options_, report),
          state_(core_.state),
          context_(report, hidden()),
          keeper_(&context_.gl(), headset),
          bodies_(options.avatars)
    {
        if (options_.hash_shown) eyes_.views().hash_pictures();
        core_.start(nullptr, [] { return kEyesPixels; }, {});
    }

    ViewRunSummary run(gi::StopRequest const& stop)
    {
        double last = state_.clock.now_s();
        while (core_.poll(stop) && !keeper_.ended()) {
            HmdSession* const session = keeper_.poll();
            if (keeper_.losses() != losses_) {
                losses_ = keeper_.losses();
                core_.report.lose("headset sessions lost", 1, keeper_.trouble());
                std::fputs(fmt::format("note: {}; waiting for the headset\n", keeper_.trouble()).c_str(), stderr);
            }
            if (session == nullptr) {
                at_last_.drawn_scale = 0;
                core_.look(at_last_);
                shoot_unseen();
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
                continue;
            }
            note_phase(*session);
            std::optional<HmdFrame> const frame = session->begin_frame();
            if (!frame) continue;
            double const now = state_.clock.now_s();
            double const seconds = now - std::exchange(last, now);
            act(*session, *frame, seconds);
            show(*session, *frame, seconds);
        }
        core_.finish();
        core_.summary.gl = context_.gl().description();
        core_.summary.headset = {{"losses", losses_},
                                 {"phases", phases_},
                                 {"shown", shown_},
                                 {"reprojected", reprojected_},
                                 {"surfaces", surfaces_},
                                 {"pose_age_ms", quantile_or_0(pose_ages_ms_, 0.5)},
                                 {"p99_pose_age_ms", quantile_or_0(pose_ages_ms_, 0.99)},
                                 {"longest_pose_age_ms", quantile_or_0(pose_ages_ms_, 1)},
                                 {"pose_cpu_ms", quantile_or_0(pose_cpu_ms_, 0.5)},
                                 {"drawing_ms", 1e3 * eyes_.drawing_s()},
                                 {"depths", with_depth_},
                                 {"views", views_},
                                 {"left_out", left_out_}};
        return core_.summary;
    }

private:
    void note_phase(HmdSession const& session)
    {
        std::string const now = name(session.phase());
        if (phases_.empty() || phases_.back() != now) phases_.push_back(now);
    }

    /// Left stick moves, right stick turns.
    void act(HmdSession& session, HmdFrame const& frame, double seconds)
    {
        constexpr double kTurn_rad_s = 1.5;
        NavigationInput in = core_.controls.motion(seconds);
        in.right += frame.hands[0].move.x;
        in.forward += frame.hands[0].move.y;
        in.turn_right_rad += frame.hands[1].move.x * kTurn_rad_s * seconds;
        state_.navigation.step(in, seconds);
        for (CommandEvent const& c : core_.controls.commands()) {
            core_.obey(c.command);
            // At the first camera the user faces its direction, however head and body are turned.
            if (c.command == Command::first_camera && session.recentre()) started_ = false;
        }
    }

    gi::dmat4 world_from_room() const
    {
        // The navigation pose is that of a head at the room's centre, at its height in the first frame.
        return state_.navigation.world_from_room() * glm::translate(gi::dmat4(1), -start_);
    }

    /// Passes on the areas that the lenses hide, so that they are not rendered.
    void tell_hidden(HmdSession const& session)
    {
        for (std::size_t eye = 0; eye < 2; ++eye) {
            HiddenMask const& mask = session.hidden(HmdEye(eye));
            if (same(mask, told_[eye])) continue;
            told_[eye] = mask;
            core_.renderer->post(hidden_change(kEyes[eye], mask), [this](std::string const& wrong) {
                if (!wrong.empty())
                    core_.report.lose("visibility masks of eyes not used: all pixels are rendered", 1, wrong);
            });
        }
    }

    void note_hidden(LiveFrame const& frame)
    {
        for (std::size_t eye = 0; eye < 2; ++eye) {
            HiddenPixels const& hidden = frame.result.views[eye].hidden;
            left_out_[eye] = hidden ? double(std::ranges::count(*hidden, 1)) / double(hidden->size()) : 0.0;
        }
    }

    static std::vector<gi::Camera> cameras(Viewpoint const& at, std::vector<HmdView> const& views)
    {
        std::vector<gi::Camera> now;
        for (HmdView const& view : views) {
            now.push_back(view.camera);
            now.back().world_from_camera = at.world_from_room * view.camera.world_from_camera;
        }
        return now;
    }

    std::vector<EyeToDraw> to_draw(std::vector<HmdView> const& views, std::vector<gi::Camera> const& now) const
    {
        std::vector<EyeToDraw> eyes;
        for (std::size_t k = 0; k < views.size(); ++k) {
            bool const as_rendered = k < 2 && !state_.settings().reproject;
            eyes.push_back(
                {as_rendered ? std::nullopt : std::optional(now[k]), {views[k].width, views[k].height}});
        }
        return eyes;
    }

    /// @param seconds  since the previous frame
    void show(HmdSession& session, HmdFrame const& frame, double seconds)
    {
        tell_hidden(session);
        if (!started_ && frame.tracked.head) {
            start_ = frame.tracked.head->position;
            if (start_.y > 0.3) state_.navigation.set_eye_height(start_.y);
            started_ = true;
        }
        Viewpoint at;
        at.pose_s = state_.clock.of_steady(frame.pose_s);
        at.display_s = at.valid_s = state_.clock.of_steady(frame.display_s);
        at.world_from_room = world_from_room();
        at.tracked = frame.tracked;
        if (UserBody* const body = bodies_.first()) body->stand(at.tracked, at.world_from_room, seconds);
        at.jump = state_.navigation.jump();
        if (eyes_.views().draws_surfaces() && !state_.wants_screenshot && !core_.requests.wants_bytes() &&
            state_.settings().reproject)
            at.drawn_scale = surfaces_scale_.next();
        std::vector<gi::Camera> now = cameras(at, frame.views);
        for (std::size_t eye = 0; eye < std::min<std::size_t>(2, now.size()); ++eye)
            at.views.push_back(
                {kEyes[eye], now[eye], frame.views[eye].width, frame.views[eye].height, eye == 0 ? -1 : 0});
        at_last_ = at;
        core_.look(at);
        auto const newest = core_.renderer->newest();
        if (!frame.should_render || !newest || newest->result.views.size() != 2) {
            shoot_unseen();
            return session.end_frame();
        }
        bool const fresh = newest != state_.frame;
        double const begun = state_.clock.now_s();
        if (fresh) {
            state_.frame = newest;
            state_.follow(newest->settings);
            eyes_.take(newest);
            note_hidden(*newest);
            core_.expose(*newest);
        }
        double const uploaded = state_.clock.now_s();
        HmdPicture picture;
        picture.views = frame.views;
        picture.values = TextureValues::srgb;
        picture.first_row = FirstRow::top;
        double const scale = state_.settings().draw_surfaces ? surfaces_scale_.next() : 0;
        FrameCommand moment = moment_at(*newest, at, at.display_s, core_.renderer->edits_since(*newest));
        eyes_.begin(scale, moment, core_.options.drive);
        if (auto latest = session.latest_views(frame)) { // as late as possible
            picture.views = std::move(*latest);
            now = cameras(at, picture.views);
            for (std::size_t eye = 0; eye < 2; ++eye) moment.views[eye].camera = now[eye];
        }
        bool const moved =
            !(newest->command.views[0].camera == now[0] && newest->command.views[1].camera == now[1]);
        eyes_.draw(to_draw(picture.views, now), tone_settings(state_.settings()));
        picture.textures = eyes_.textures();
        picture.depths = eyes_.depths();
        views_ = picture.views.size();
        HmdCounts const before = session.counts();
        session.end_frame(picture);
        if (session.counts().pictures > before.pictures)
            note_handed_over(session, session.counts().with_depth > before.with_depth);
        moment.display_s = at.display_s;
        ShownViews const* const views = &eyes_.views();
        core_.note_shown(shown_frame(std::move(moment), {&views, 1}));
        ++shown_;
        double const drawing_s = eyes_.drawing_s();
        if (eyes_.views().drew_surfaces()) {
            ++surfaces_;
            surfaces_scale_.measured(scale, std::max(state_.clock.now_s() - begun, drawing_s), frame.period_s);
        } else if (moved) {
            ++reprojected_;
        }
        if (!eyes_.views().why_no_surfaces().empty() && !std::exchange(no_surfaces_told_, true))
            core_.report.lose("surfaces not drawn, pictures are reprojected", 1, eyes_.views().why_no_surfaces());
        ++core_.summary.presented;
        shoot();
        FrameTimes times;
        times.frame = newest->command.frame;
        times.pose_s = newest->command.pose_s;
        times.display_s = state_.clock.of_steady(frame.display_s);
        times.swap_s = times.display_s;
        times.swap_method = SwapMethod::openxr;
        times.swap_uncertainty_ms = 0.5e3 * frame.period_s;
        times.render_ms = 1e3 * (newest->done_s - newest->begun_s);
        times.upload_ms = 1e3 * (uploaded - begun);
        times.draw_ms = 1e3 * (state_.clock.now_s() - uploaded);
        times.paths = newest->command.paths;
        times.width = newest->command.views[0].width;
        times.height = newest->command.views[0].height;
        times.late_ms = 1e3 * (times.swap_s - newest->command.display_s);
        times.reprojected = moved || newest->command.only_light;
        core_.log(times);
    }

    void note_handed_over(HmdSession const& session, bool with_depth)
    {
        pose_ages_ms_.push_back(1e3 * session.pose_age_s());
        pose_cpu_ms_.push_back(1e3 * session.pose_cpu_s());
        with_depth_ += with_depth;
        if (session.takes_depths() && !with_depth)
            core_.report.lose("pictures that the headset got without depths", 1, "their depths are not known");
    }

    /// Saves what the eyes see now, if asked to.
    void shoot()
    {
        Snapshot shot;
        bool const only_light = state_.frame && state_.frame->command.only_light; // its picture is saved, too
        if (!only_light && std::exchange(state_.wants_screenshot, false)) {
            std::array<Snapshot, 2> eyes;
            for (std::size_t eye = 0; eye < 2; ++eye) {
                DrawTarget const target = eyes_.target(eye);
                eyes[eye] = {target.size_px, read_bytes(target)};
            }
            shot = side_by_side(eyes);
            if (std::exchange(state_.own_screenshot, false)) core_.save_screenshot(shot);
        }
        core_.requests.presented(state_.clock.now_s(), shot);
        if (core_.requests.wants_bytes()) state_.wants_screenshot = true;
    }

    /// While the headset shows nothing (taken off, lost), screenshots use the last rendered pictures of the eyes.
    void shoot_unseen()
    {
        auto const newest = core_.renderer->newest();
        if (!state_.wants_screenshot || !newest || newest->result.views.size() != 2) return;
        if (newest->command.only_light) return;
        std::vector<EyeToDraw> eyes;
        for (ViewCommand const& view : newest->command.views) eyes.push_back({{}, {view.width, view.height}});
        state_.frame = newest;
        eyes_.take(newest);
        eyes_.draw(eyes, tone_settings(state_.settings()));
        shoot();
    }

    ViewOptions const options_;
    ViewCore core_;
    ViewState& state_;
    HmdContext context_;
    HmdEyes eyes_;
    HmdKeeper keeper_; ///< declared after the context, so that its sessions end first
    UserBodies bodies_;
    gi::dvec3 start_{0};
    Viewpoint at_last_; ///< while there is no headset, too
    bool started_ = false;
    int losses_ = 0;
    std::vector<std::string> phases_;
    std::uint64_t shown_ = 0, reprojected_ = 0, surfaces_ = 0;
    std::vector<double> pose_ages_ms_, pose_cpu_ms_; ///< of pictures: HmdSession::pose_age_s, pose_cpu_s
    std::uint64_t with_depth_ = 0;
    std::size_t views_ = 0; ///< of the last picture
    SurfacesScale surfaces_scale_;
    bool no_surfaces_told_ = false;
    std::array<HiddenMask, 2> told_;
    std::array<double, 2> left_out_{}; ///< share of the pixels of each eye
};

} // namespace

ViewRunSummary run_hmd(ViewOptions const& options, HmdOptions const& headset, gi::StopRequest const& stop,
                       gi::Report& report)
{
    return HmdLoop(options, headset, report).run(stop);
}

} // namespace viewer
