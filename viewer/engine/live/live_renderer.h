#pragma once
// The thread that renders: it takes what was changed and where the users are, makes an order of it, renders that
// and hands the newest frame out. Nobody waits for it: windows, sockets and trackers are other threads' business.
//
// While something moves it holds the rate of the settings; while nothing does it refines the picture until that
// has kConvergedPaths per pixel, and rests. A change of the point of view while it refines ends the frame at hand
// after its next path.

#include "viewer/engine/governor.h"
#include "viewer/engine/render_session.h"
#include "viewer/engine/update_governor.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace viewer {

/// Seconds since the session began, on the steady clock.
class SessionClock {
public:
    double now_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    double at_s(std::chrono::steady_clock::time_point t) const
    {
        return std::chrono::duration<double>(t - start_).count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// Where the users are and what they look through, as last known.
struct Viewpoint {
    double pose_s = 0, display_s = 0; ///< session clock
    gi::dmat4 world_from_room{1};
    Tracked tracked;
    std::vector<Tracked> others;    ///< as in FrameCommand
    std::vector<ViewCommand> views; ///< at full size
};

struct LiveFrame {
    FrameCommand order;               ///< with the views that were rendered here
    std::vector<ViewCommand> ordered; ///< where these are not all of them: all
    SessionFrame result;
    FrameBudget budget;
    double begun_s = 0, done_s = 0; ///< session clock
    std::uint32_t still_paths = 0;  ///< per pixel since nothing moves
    Settings settings;              ///< that it was rendered with
    std::string schedule;           ///< of slhb: the one in use and why, a sentence; empty of other methods
};

inline constexpr std::uint32_t kConvergedPaths = 4096;

/// What a frame was to those who rendered it.
struct FrameWork {
    double seconds = 0;
    gi::DynamicUpdate dynamic_update{};
    bool moved = false; ///< something in the scene
};

/// Others who render the same orders: the ranks of a cluster. All but `swapped` is called on the rendering thread.
class FrameLink {
public:
    virtual ~FrameLink() = default;
    /// First and last, on the rendering thread.
    virtual void begin() = 0;
    virtual void end() = 0;
    virtual bool leads() const = 0;
    virtual void send(FrameCommand const& order) = 0;
    /// Empty at the end.
    virtual std::optional<FrameCommand> receive() = 0;
    /// While there is nothing to render, now and then: throws where a rank was lost that cannot be done without.
    virtual void check() = 0;
    /// Returns when all have drawn the frame and may swap. @param own  of this rank
    /// @return of the leader: of the ranks that took longest, for the whole and for what follows; else `own`
    virtual FrameWork wait_for_all(FrameCommand const& order, FrameWork const& own) = 0;
    /// From the thread that shows frames: it is drawn; returns when all may swap.
    virtual void drawn(std::uint64_t frame) = 0;
    virtual void swapped(std::uint64_t frame, double steady_s) = 0;
};

class LiveRenderer {
public:
    /// Called on the rendering thread.
    struct Hooks {
        std::function<void(LiveFrame const&)> finished; ///< before anyone sees it
        std::function<void()> published;                ///< there is a newer frame
        std::function<void(std::string const&)> failed; ///< a frame could not be rendered; it goes on
        std::function<std::vector<ViewCommand>(FrameCommand const&)> own_views; ///< of a rank; empty = as ordered
    };

    /// @param session, clock, link  outlive it; link may be null
    LiveRenderer(RenderSession& session, SessionClock const& clock, FrameLink* link, Hooks hooks);
    ~LiveRenderer();

    /// From any thread. `done` is called on the rendering thread with what was wrong, or empty.
    void post(Change change, std::function<void(std::string const& error)> done = {});
    /// Called with the session between two frames.
    void ask(std::function<void(RenderSession&)> question);
    void look(Viewpoint viewpoint);
    /// One more frame, also where nothing has changed.
    void again();
    /// To a moment of the scene's clips, s.
    void go_to(double scene_s);

    /// Null before the first.
    std::shared_ptr<LiveFrame const> newest() const;
    /// No frame is being rendered, and none is due: `newest` stays until something changes. Never of a follower.
    bool rests() const;
    /// Waits for a frame that began after everything that was posted before; null when stopped.
    std::shared_ptr<LiveFrame const> next_frame(double timeout_s);
    bool stopped() const { return stopped_; } ///< a follower whose leader has ended
    void stop();

private:
    void run();
    void run_linked();
    void run_leading();
    void run_following();
    void do_jobs();
    bool scene_may_move(Viewpoint const& now) const;
    bool anything_moves(Viewpoint const& now) const;
    void choose_followed(bool may_move);
    void measure(FrameWork const& work, FrameBudget const& budget);
    FrameCommand make_order(Viewpoint const& now, bool still, FrameBudget& budget);
    bool render(FrameCommand order, FrameBudget const& budget);
    void wait_until(double time_s);

    RenderSession& session_;
    SessionClock const& clock_;
    FrameLink* link_;
    Hooks hooks_;

    mutable std::mutex mutex_;
    std::condition_variable wake_, published_;
    std::deque<std::function<void()>> jobs_;
    Viewpoint viewpoint_;
    std::atomic<bool> looked_{false}; ///< since the frame at hand began
    std::shared_ptr<gi::StopRequest> refining_;
    std::shared_ptr<LiveFrame const> newest_;
    bool resting_ = false;
    std::atomic<bool> quit_{false}, stopped_{false};

    // Of the rendering thread
    Governor governor_;
    UpdateGovernor follow_governor_;
    int stored_ = 0; ///< directions, where a frame was measured last
    std::vector<Change> changes_;
    FrameCommand last_;
    std::vector<ViewCommand> last_views_; ///< all that were ordered
    bool has_last_ = false;
    double scene_s_ = 0, last_begun_s_ = 0;
    std::uint64_t frame_ = 0;
    std::uint32_t still_paths_ = 0;
    std::thread thread_;
};

} // namespace viewer
