#include "viewer/camera_view/hmd_run.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "viewer/devices/gl/pass_through_pass.h"
#include "viewer/devices/gl/window.h"
#include "viewer/devices/xr/keeper.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {
namespace {

constexpr std::chrono::seconds kPatience{3}; ///< waiting time for the end of the runtime's session

/// Surfaceless where there is no display server, else of a hidden window.
struct Context {
    std::unique_ptr<Window> window;
    std::optional<GlContext> own;

    explicit Context(gi::Report& report)
    {
        char const* const display = std::getenv("DISPLAY");
        if (display == nullptr || *display == '\0') {
            own = GlContext::surfaceless(report);
            return;
        }
        WindowSettings settings;
        settings.size_px = {64, 64};
        settings.visibility = Visibility::hidden;
        window = std::make_unique<Window>(settings, report);
    }
    GlContext const& gl() const { return window ? window->gl() : *own; }
};

class Loop {
public:
    Loop(ar::Session const& session, ArHmdOptions const& options, gi::Report& report, ArHmdSummary& summary)
        : hmd_(session.hmd.value_or(ar::HmdCameras{})),
          options_(options),
          context_(report),
          keeper_(&context_.gl(), options.headset),
          pass_through_(session, options.pass_through, report),
          summary_(summary)
    {
        context_.gl().make_current();
        for (ar::CameraModel const& camera : pass_through_.cameras()) passes_.emplace_back(camera);
    }

    void run(gi::StopRequest const& stop)
    {
        try {
            while (!stop.requested() && !keeper_.ended() && !is_over()) step();
            pass_through_.end();
            tell();
            keep_eyes();
            leave();
        } catch (...) {
            pass_through_.end();
            tell();
            throw;
        }
        tell();
        pass_through_.rethrow();
    }

private:
    void tell()
    {
        summary_.frames = pass_through_.counts();
        summary_.first_seen_ms = ar::spread_of(first_seen_ms_);
        summary_.age_ms = ar::spread_of(age_ms_);
        summary_.losses = keeper_.losses();
    }

    /// True if the last composite was seen, or the headset is not in use.
    bool is_over() const
    {
        return pass_through_.has_ended() && (pass_through_.newest() == frame_ || unseen_ > 100);
    }

    void step()
    {
        HmdSession* const session = keeper_.poll();
        if (session == nullptr) {
            ++unseen_;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            return;
        }
        note(*session);
        std::optional<HmdFrame> const next = session->begin_frame();
        unseen_ = next && next->should_render ? 0 : unseen_ + 1;
        if (!next) return;
        if (next->has_pose && next->tracked.head) path_.add(next->display_s, *next->tracked.head);
        auto const newest = pass_through_.newest();
        if (!next->should_render || !newest) return session->end_frame();
        context_.gl().make_current();
        bool const fresh = newest != frame_;
        if (fresh) take(newest);
        show(*session, *next);
        age_ms_.push_back(1e3 * (next->display_s - newest->captured_s));
        if (fresh) first_seen_ms_.push_back(age_ms_.back());
        ++summary_.shown;
        summary_.fresh += fresh;
        summary_.blind += !next->has_pose;
    }

    void note(HmdSession const& session)
    {
        std::string const now = name(session.phase());
        if (summary_.phases.empty() || summary_.phases.back() != now) summary_.phases.push_back(now);
        if (summary_.headset.empty()) summary_.headset = session.info().runtime + ", " + session.info().system;
    }

    void take(std::shared_ptr<PassThroughFrame const> const& newest)
    {
        frame_ = newest;
        for (std::size_t k = 0; k < passes_.size(); ++k) passes_[k].take(newest->rgb[k]);
        room_from_head_ = path_.at(newest->captured_s);
    }

    /// Pose of an eye's camera when the frame was taken.
    gi::RigidPose room_from_camera(std::size_t eye, gi::RigidPose const& room_from_head) const
    {
        gi::RigidPose const left = room_from_head * hmd_.head_from_camera;
        return eye == 1 && hmd_.right ? left * hmd_.right->left_from_right : left;
    }

    void show(HmdSession& session, HmdFrame const& frame)
    {
        HmdPicture picture;
        picture.views = session.latest_views(frame).value_or(frame.views);
        picture.values = TextureValues::srgb;
        picture.first_row = FirstRow::top;
        for (std::size_t eye = 0; eye < 2; ++eye) {
            HmdView const& view = picture.views[eye];
            glm::ivec2 const size{view.width, view.height};
            if (!targets_[eye] || sizes_[eye] != size) targets_[eye].emplace(TextureTarget::Format::bytes, size);
            sizes_[eye] = size;
            // Without head tracking the plane moves with the eyes.
            gi::RigidPose const head =
                frame.has_pose && room_from_head_ ? *room_from_head_ : middle_of(picture.views);
            passes_[std::min(eye, passes_.size() - 1)].draw(targets_[eye]->target(), view.camera,
                                                            room_from_camera(eye, head), hmd_.plane_m);
            picture.textures.push_back(targets_[eye]->shown().texture);
        }
        session.end_frame(picture);
    }

    static gi::RigidPose middle_of(std::vector<HmdView> const& views)
    {
        gi::dmat4 const &a = views[0].camera.world_from_camera, &b = views[1].camera.world_from_camera;
        return {0.5 * glm::dvec3(a[3] + b[3]), glm::normalize(glm::quat_cast(glm::dmat3(a)))};
    }

    void keep_eyes()
    {
        if (options_.eyes.empty()) return;
        std::filesystem::create_directories(options_.eyes);
        context_.gl().make_current();
        for (std::size_t eye = 0; eye < 2; ++eye) {
            if (!targets_[eye]) continue;
            std::vector<unsigned char> const bytes = read_bytes(targets_[eye]->target());
            gi::write_png(options_.eyes / (eye == 0 ? "left.png" : "right.png"), sizes_[eye].x, sizes_[eye].y,
                          bytes);
        }
    }

    void leave()
    {
        auto const until = std::chrono::steady_clock::now() + kPatience;
        if (HmdSession* const session = keeper_.poll()) session->request_exit();
        while (!keeper_.ended() && std::chrono::steady_clock::now() < until) {
            HmdSession* const session = keeper_.poll();
            if (session == nullptr) break;
            if (session->begin_frame()) session->repeat_frame();
        }
    }

    ar::HmdCameras hmd_;
    ArHmdOptions const& options_;
    Context context_;
    HmdKeeper keeper_; ///< created before the scenes are loaded: nothing runs without a headset
    PassThrough pass_through_;
    std::deque<PassThroughPass> passes_;
    std::array<std::optional<TextureTarget>, 2> targets_;
    std::array<glm::ivec2, 2> sizes_{};
    HeadPath path_;
    std::shared_ptr<PassThroughFrame const> frame_; ///< currently shown
    std::optional<gi::RigidPose> room_from_head_;   ///< when it was taken
    std::vector<double> first_seen_ms_, age_ms_;
    int unseen_ = 0; ///< number of rounds without a visible frame
    ArHmdSummary& summary_;
};

} // namespace

void HeadPath::add(double steady_s, gi::RigidPose const& room_from_head)
{
    if (!poses_.empty() && steady_s <= poses_.back().time_s) poses_.pop_back(); // a newer prediction
    if (!poses_.empty() && steady_s <= poses_.back().time_s) return;
    poses_.push_back({steady_s, room_from_head});
    while (poses_.front().time_s < steady_s - kKept_s) poses_.pop_front();
}

std::optional<gi::RigidPose> HeadPath::at(double steady_s) const
{
    if (poses_.empty()) return std::nullopt;
    auto const after = std::upper_bound(poses_.begin(), poses_.end(), steady_s,
                                        [](double t, ar::TimedPose const& p) { return t < p.time_s; });
    if (after == poses_.begin()) return poses_.front().world_from_camera;
    if (after == poses_.end()) return poses_.back().world_from_camera;
    ar::TimedPose const &a = *(after - 1), &b = *after;
    double const t = (steady_s - a.time_s) / (b.time_s - a.time_s);
    return gi::RigidPose{glm::mix(a.world_from_camera.position, b.world_from_camera.position, t),
                         glm::slerp(a.world_from_camera.rotation, b.world_from_camera.rotation, t)};
}

void run_ar_in_hmd(ar::Session const& session, ArHmdOptions const& options, gi::StopRequest const& stop,
                   gi::Report& report, ArHmdSummary& summary)
{
    Loop(session, options, report, summary).run(stop);
}

std::string describe(ArHmdSummary const& s)
{
    PassThroughCounts const& f = s.frames;
    std::string text = fmt::format("{} composites, camera found in {}, {} frames overtaken\n{}source: {}{}\n",
                                   f.frames, f.poses.found(), f.overtaken, describe(f.poses), describe(f.left),
                                   f.end.kind == ar::SourceState::Kind::lost ? "; lost: " + f.end.reason : "");
    if (f.right.delivered > 0) text += fmt::format("right source: {}, {} alone\n", describe(f.right), f.alone);
    if (f.refused > 0) text += fmt::format("refused: {} frames\n", f.refused);
    text += fmt::format("headset: {}; {}\n", s.headset, fmt::join(s.phases, ", "));
    text +=
        fmt::format("{} pictures shown, {} of them with a new composite, {} without a pose, {} sessions lost\n",
                    s.shown, s.fresh, s.blind, s.losses);
    text += fmt::format("{:<30} {:>9} {:>9} {:>9}\n", "", "median", "95 %", "most");
    for (auto const& [what, d] : {std::pair{"capture to first seen (ms)", s.first_seen_ms},
                                  std::pair{"age of what is seen (ms)", s.age_ms}})
        text += fmt::format("{:<30} {:>9.2f} {:>9.2f} {:>9.2f}\n", what, d.median, d.p95, d.most);
    return text;
}

} // namespace viewer
