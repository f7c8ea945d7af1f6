#include "viewer/camera_view/pass_through.h"

#include "ar/capture/clock.h"
#include "ar/capture/open_source.h"
#include "ar/markers/marker_map_file.h"
#include "ar/runtime/frame_clock.h"
#include "gi/core/error.h"
#include "viewer/camera_view/camera_tracker.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr std::chrono::milliseconds kWait{20}; ///< interval for checking stop requests
constexpr double kUsualRate_hz = 30;

ar::Session right_session(ar::Session s)
{
    s.camera = s.hmd->right->calibration;
    s.frames.source = s.hmd->right->source;
    return s;
}

} // namespace

/// One camera with the pipeline that adds virtual objects to its frames.
struct PassThrough::Side {
    /// @param prefix  for the pipeline's counts in the report
    Side(ar::Session const& session_, ar::Pace pace, gi::Report& report, std::string const& prefix)
        : session(session_),
          camera(ar::load_camera(session.camera, &report)),
          pipeline(session, camera, ar::read_marker_map(session.markers, &report), report, prefix)
    {
        ar::OpenOptions open = session.frames.options;
        open.pace = pace;
        source = ar::open_source(session.frames.source, open);
        about = source->description();
        ar::check_size(about.size_px, camera);
        clock.emplace(session.frames.source, about, false);
    }
    /// Since its first frame; of cameras on the steady clock, which two of them share.
    double time_of(ar::Frame const& f) { return about.is_live ? f.captured_s : (*clock)(f); }
    double half_period_s() const { return 0.5 / (about.frames_per_s > 0 ? about.frames_per_s : kUsualRate_hz); }

    ar::Session session;
    ar::CalibratedCamera camera;
    ar::Pipeline pipeline;
    std::unique_ptr<ar::FrameSource> source;
    ar::SourceDescription about;
    std::optional<ar::FrameClock> clock;
    std::optional<ar::Frame> waiting; ///< taken, and not yet used
};

PassThrough::PassThrough(ar::Session const& session, PassThroughOptions const& options, gi::Report& report)
    : session_(session), options_(options), report_(report)
{
    sides_.push_back(std::make_unique<Side>(session, options.pace, report, ""));
    // For files the left source sets the pace, and the right one follows.
    if (session.hmd && session.hmd->right)
        sides_.push_back(
            std::make_unique<Side>(right_session(session), ar::Pace::fastest, report, "right camera: "));
    for (auto const& side : sides_) models_.push_back(side->camera.model);
    thread_ = std::thread([this] {
        try {
            run();
        } catch (...) {
            std::lock_guard const lock(mutex_);
            problem_ = std::current_exception();
        }
        ended_ = true;
    });
}

PassThrough::~PassThrough() { end(); }

void PassThrough::end()
{
    stop_.request();
    if (thread_.joinable()) thread_.join();
}

std::shared_ptr<PassThroughFrame const> PassThrough::newest() const
{
    std::lock_guard const lock(mutex_);
    return newest_;
}

PassThroughCounts PassThrough::counts() const
{
    std::lock_guard const lock(mutex_);
    return counts_;
}

void PassThrough::rethrow() const
{
    if (problem_) std::rethrow_exception(problem_);
}

void PassThrough::run()
{
    Side& left = *sides_[0];
    Side* const right = sides_.size() > 1 ? sides_[1].get() : nullptr;
    std::optional<double> first_s;
    while (!stop_.requested() && (options_.frames == 0 || counts().frames < std::uint64_t(options_.frames))) {
        std::optional<ar::Frame> frame = left.source->next(kWait);
        std::uint64_t overtaken = 0;
        if (frame) left.time_of(*frame); // the first is that of all
        if (frame && options_.pace == ar::Pace::own)
            for (; auto newer = left.source->next(std::chrono::milliseconds(0)); ++overtaken)
                frame = std::move(newer);
        {
            std::lock_guard const lock(mutex_);
            counts_.overtaken += overtaken;
            counts_.left = left.source->counts();
            counts_.end = left.source->state();
            if (right != nullptr) counts_.right = right->source->counts();
            if (!frame && counts_.end.kind != ar::SourceState::Kind::running) return;
        }
        if (!frame) continue;
        double const at_s = left.time_of(*frame);
        if (!first_s) first_s = at_s;
        if (options_.pace == ar::Pace::fastest && !left.about.is_live) frame->captured_s = ar::steady_now_s();
        bool is_alone = false;
        if (right != nullptr) {
            // Right frames from before the left one's time have no partner any more.
            while (!stop_.requested()) {
                if (!right->waiting) right->waiting = right->source->next(kWait);
                if (!right->waiting) {
                    if (right->source->state().kind == ar::SourceState::Kind::running) continue;
                    std::lock_guard const lock(mutex_);
                    counts_.right = right->source->counts();
                    counts_.end = right->source->state();
                    return;
                }
                double const other_s = right->time_of(*right->waiting);
                is_alone = other_s > at_s + right->half_period_s();
                if (is_alone || other_s >= at_s - right->half_period_s()) break;
                right->waiting.reset();
            }
            if (stop_.requested()) return;
        }
        if (is_alone) {
            report_.lose("frames of the left camera without one of the right");
            std::lock_guard const lock(mutex_);
            ++counts_.alone;
            continue;
        }
        try {
            auto const made = composited(*frame, right != nullptr ? &*right->waiting : nullptr, at_s - *first_s);
            if (stop_.requested()) return; // the picture may be incomplete
            std::lock_guard const lock(mutex_);
            if (right != nullptr) counts_.right = right->source->counts();
            ++counts_.frames;
            counts_.poses.add(made->used.state, made->confidence, made->is_estimated);
            newest_ = made;
        } catch (gi::InputError const& e) {
            report_.lose("frames that could not be used", 1, e.what());
            std::lock_guard const lock(mutex_);
            ++counts_.refused;
        }
        if (right != nullptr) right->waiting.reset();
    }
}

std::shared_ptr<PassThroughFrame> PassThrough::composited(ar::Frame const& frame, ar::Frame const* other,
                                                          double time_s)
{
    auto made = std::make_shared<PassThroughFrame>();
    made->sequence = frame.sequence;
    made->captured_s = frame.captured_s;
    std::optional<std::optional<gi::RigidPose>> known;
    if (options_.tracked)
        known = options_.tracked(frame);
    else if (!options_.poses.empty())
        known = ar::recorded_pose(options_.poses, time_s);
    ar::FrameResult left = sides_[0]->pipeline.find(frame, time_s, known, {}, &stop_);
    sides_[0]->pipeline.add(left, frame, time_s, stop_);
    made->used = left.used;
    made->is_estimated = left.pose.found();
    made->confidence = left.pose.confidence;
    if (left.rgb.depth() != CV_8U) report_.lose("frames shown with 8 bits of 16 or more", 1, "the headset");
    made->rgb.push_back(ar::eight_bits_of(left.rgb).clone());
    if (other != nullptr && left.used.world_from_camera) {
        gi::RigidPose const world_from_right = *left.used.world_from_camera * session_.hmd->right->left_from_right;
        ar::FrameResult right = sides_[1]->pipeline.find(*other, time_s, world_from_right);
        right.used = left.used;
        right.used.world_from_camera = world_from_right;
        sides_[1]->pipeline.add(right, *other, time_s, stop_);
        made->rgb.push_back(ar::eight_bits_of(right.rgb).clone());
    } else if (other != nullptr) {
        made->rgb.push_back(ar::rgb_of(*other).clone());
    }
    made->done_s = ar::steady_now_s();
    return made;
}

} // namespace viewer
