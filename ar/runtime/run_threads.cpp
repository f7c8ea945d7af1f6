#include "ar/runtime/run_threads.h"

#include "ar/capture/clock.h"

#include <algorithm>

namespace ar {
namespace {

/// Copies device memory, since cameras have few buffers and frames in progress must not hold them.
void give_back(FrameInFlight& w)
{
    if (!w.frame.owner) return;
    FrameResult& r = w.result;
    if (r.camera.data == w.frame.planes[0].data) r.rgb = r.camera = r.camera.clone();
    w.frame.planes = {};
    w.frame.owner.reset();
}

} // namespace

RunThreads::RunThreads(FrameSource& source, Pipeline& pipeline, RunOptions const& options, bool is_timed,
                       FrameClock const& clock, gi::Report& report)
    : source_(source), pipeline_(pipeline), options_(options), is_timed_(is_timed), clock_(clock), report_(report)
{
    finder_ = std::thread([this] { guarded([this] { find_all(); }, found_); });
    adder_ = std::thread([this] { guarded([this] { add_all(); }, done_); });
}

void RunThreads::end()
{
    ending_.request();
    found_.abandon();
    done_.abandon();
    if (finder_.joinable()) finder_.join();
    if (adder_.joinable()) adder_.join();
}

void RunThreads::tell(RunSummary& s) const
{
    std::lock_guard const lock(mutex_);
    s.source = counts_;
    s.end = state_;
    s.refused = refused_;
    s.overtaken = overtaken_;
}

void RunThreads::rethrow() const
{
    if (problem_) std::rethrow_exception(problem_);
}

/// Frames that `work` handed over before it threw are still processed.
void RunThreads::guarded(std::function<void()> const& work, HandOver<FrameInFlight>& filled)
{
    try {
        work();
    } catch (...) {
        std::lock_guard const lock(mutex_);
        if (!problem_) problem_ = std::current_exception();
    }
    filled.close();
}

void RunThreads::hand_over(FrameInFlight w, HandOver<FrameInFlight>& to)
{
    if (!is_timed_) {
        to.put(std::move(w));
        return;
    }
    to.replace(std::move(w), [this](FrameInFlight const& older, FrameInFlight& newer) {
        newer.overtaken += older.overtaken + 1;
        std::lock_guard const lock(mutex_);
        ++overtaken_;
    });
}

void RunThreads::find_all()
{
    constexpr std::chrono::milliseconds kWait{20}; // interval for checking stop requests
    int found = 0;
    while (!ending_.requested()) {
        // At own pace the caller counts the frames shown.
        if (!is_timed_ && options_.frames > 0 && found == options_.frames) break;
        double const asked_s = steady_now_s();
        std::optional<Frame> frame = source_.next(kWait);
        {
            std::lock_guard const lock(mutex_);
            counts_ = source_.counts();
            state_ = source_.state();
            if (!frame && state_.kind != SourceState::Kind::running) break;
        }
        if (!frame) continue;
        FrameInFlight w;
        w.time_s = clock_(*frame);
        w.read_ms = 1e3 * (steady_now_s() - asked_s);
        w.frame = std::move(*frame);
        try {
            if (options_.taken) options_.taken(w.frame);
            w.result = found_in(w);
        } catch (gi::InputError const& e) {
            refuse(e);
            continue;
        }
        ++found;
        give_back(w);
        hand_over(std::move(w), found_);
    }
}

FrameResult RunThreads::found_in(FrameInFlight const& w)
{
    std::optional<double> const begun_s = is_timed_ ? std::optional(w.frame.arrived_s) : std::nullopt;
    std::optional<std::optional<gi::RigidPose>> known;
    if (options_.tracked)
        known = options_.tracked(w.frame);
    else if (!options_.poses.empty())
        known = recorded_pose(options_.poses, w.time_s);
    return pipeline_.find(w.frame, w.time_s, known, begun_s, &ending_);
}

void RunThreads::add_all()
{
    try {
        while (std::optional<FrameInFlight> w = found_.take()) {
            try {
                if (!options_.find_poses_only)
                    pipeline_.add(w->result, w->frame, w->time_s, ending_, options_.composite);
            } catch (gi::Interrupted const&) {
                if (!ending_.requested()) throw;
                break;
            } catch (gi::InputError const& e) {
                refuse(e);
                continue;
            }
            if (ending_.requested()) break; // the picture may be incomplete
            hand_over(std::move(*w), done_);
        }
    } catch (...) {
        ending_.request();
        found_.abandon();
        throw;
    }
}

void RunThreads::refuse(gi::InputError const& e)
{
    report_.lose("frames that could not be used", 1, e.what());
    std::lock_guard const lock(mutex_);
    ++refused_;
}

} // namespace ar
