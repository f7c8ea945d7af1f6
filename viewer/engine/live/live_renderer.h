#pragma once
// The rendering thread: collects the changes and the users' poses into a frame command, renders it and publishes
// the newest frame. No other thread waits for it; windows, sockets and trackers have their own threads.
//
// While something moves, it holds the frame rate of the settings. While nothing moves, it refines the picture up
// to kConvergedPaths per pixel and then rests. If the viewpoint changes during refinement, the current frame is
// given up, or ends after its next path if the method cannot give it up.

#include "viewer/engine/governor.h"
#include "viewer/engine/live/viewpoint.h"
#include "viewer/engine/render_session.h"
#include "viewer/engine/update_governor.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace viewer {

/// The clock of a session: seconds since it began. Trackers, headsets and other processes count the same seconds from
/// the start of the steady clock. Tests override what time it is.
class SessionClock {
public:
    virtual ~SessionClock() = default;
    virtual double now_s() const { return at_s(Clock::now()); }
    double at_s(std::chrono::steady_clock::time_point t) const
    {
        return std::chrono::duration<double>(t - start_).count();
    }
    double of_steady(double steady_s) const { return steady_s - start_s(); }
    double to_steady(double session_s) const { return session_s + start_s(); }

private:
    using Clock = std::chrono::steady_clock;
    double start_s() const { return std::chrono::duration<double>(start_.time_since_epoch()).count(); }

    Clock::time_point start_ = Clock::now();
};

struct LiveFrame {
    FrameCommand command;             ///< with the views rendered by this process
    std::vector<ViewCommand> ordered; ///< all views, if other processes render some of them; else empty
    SessionFrame result;
    /// Of `ordered`, null where nobody knows it; empty: that of the views of `result` is all there is.
    std::vector<std::shared_ptr<gi::LightPicture const>> light;
    FrameBudget budget;
    double begun_s = 0, done_s = 0; ///< session clock
    double ahead_s = 0;             ///< the command's scene_s is that of so much after begun_s
    std::uint32_t still_paths = 0;  ///< per pixel since anything last moved
    Settings settings;              ///< used for this frame
    std::uint64_t edits = 0;        ///< of the scene that were posted before it, see LiveRenderer::edits_since
    std::string schedule;           ///< what the plan chose and why, a sentence; empty = nothing
};

inline constexpr std::uint32_t kConvergedPaths = 4096;

/// Cost of a frame on the ranks that rendered it.
struct FrameWork {
    double seconds = 0;
    gi::DynamicUpdate dynamic_update{};
    bool moved = false;    ///< something in the scene moved
    double surfaces_s = 0; ///< the part of `seconds` spent on surfaces of another size than light
};

/// What windows show next: the pictures of a frame, for newer poses.
struct ShownMoment {
    FrameCommand moment; ///< the frame's, with all views, and the poses, cameras and scene time that are shown
    double surfaces_scale = 0; ///< side of drawn surfaces over that of the views; 0 = none
    std::uint64_t number = 0;  ///< counts them, from 1; set by the link
};

/// Light of a frame that its ranks give to each other.
struct FrameLight {
    /// Of the views of the command that all ranks got, each once known.
    std::vector<std::shared_ptr<gi::LightPicture const>> views;
    std::shared_ptr<gi::LightCellTable const> cells; ///< the leader's; null = none
};

/// What a rank, or all of them together, say of the picture that they showed last.
struct ShownState {
    bool draws_surfaces = false; ///< those of all views could be drawn
    bool fades = false;          ///< something fades in: draw again soon
};

/// Link to other processes that render the same frame commands and show the same moments: the ranks of a cluster.
class FrameLink {
public:
    virtual ~FrameLink() = default;
    /// The first and the last call, on the rendering thread.
    virtual void begin() = 0;
    virtual void end() = 0;
    virtual bool leads() const = 0;

    // Rendering thread. Calls throw if a rank that is needed was lost.
    virtual void send(FrameCommand const& command) = 0;
    /// Empty when the session ends.
    virtual std::optional<FrameCommand> receive() = 0;
    /// Called now and then while there is nothing to render.
    virtual void check() = 0;
    /// Gives the light of this rank's views to the others; returns when that of all is there.
    virtual FrameLight exchange(FrameCommand const& command, FrameLight own) = 0;
    /// This rank can show the frame. On the leader: returns when all ranks can. @param own  of this rank
    /// @return on the leader: of the ranks with the longest frame and the longest dynamic update; else `own`
    virtual FrameWork wait_for_all(FrameCommand const& command, FrameWork const& own) = 0;

    // Main and presenting thread. After the end they do nothing.
    /// Leader: all ranks show this next. @return its number
    virtual std::uint64_t show(ShownMoment moment) = 0;
    /// Follower: what the leader shows, if it is new.
    virtual std::optional<ShownMoment> next_shown() = 0;
    /// Called when something new is there for next_shown(), or the session has ended, on any thread.
    virtual void wake_by(std::function<void()> wake) = 0;
    /// It is drawn here; returns when it is on all ranks.
    virtual void drawn(std::uint64_t number, ShownState own) = 0;
    virtual void swapped(std::uint64_t number, double steady_s) = 0;
    /// Leader: what they showed last: whether all could draw surfaces, and whether any fades.
    virtual ShownState shown_state() const = 0;
};

class LiveRenderer {
public:
    /// Called on the rendering thread.
    struct Hooks {
        std::function<void(LiveFrame const&)> finished; ///< before the frame is published
        std::function<void()> published;                ///< a newer frame is available
        std::function<void(gi::Step const&)> at_step;   ///< where the current frame is; may be empty
        std::function<void(std::string const&)> failed; ///< a frame could not be rendered; rendering continues
        /// Views of this rank; empty = all.
        std::function<std::vector<ViewCommand>(FrameCommand const&)> own_views;
    };

    /// @param session, clock, link  must outlive it; link may be null
    LiveRenderer(RenderSession& session, SessionClock const& clock, FrameLink* link, Hooks hooks);
    ~LiveRenderer();

    /// Queues a change, from any thread. `done` is called on the rendering thread with the error
    /// message, empty if there was none.
    void post(Change change, std::function<void(std::string const& error)> done = {});
    /// Whether recordings and other ranks have a scene from their start, or need the change "scene".
    enum class SceneKnown { no, yes };
    /// Queues a loaded scene. Nothing is rendered from then on until `resume`, so that the new scene is not seen
    /// from the old one's camera; followers do not wait. `done` is called as for post, after the scene is adopted.
    void adopt(std::shared_ptr<PreparedScene> scene, SceneKnown known,
               std::function<void(RenderSession const&, std::uint64_t scene)> done);
    /// Call after the first `look` at the new scene.
    void resume(std::uint64_t scene);
    /// Runs `question` on the rendering thread between two frames.
    void ask(std::function<void(RenderSession&)> question);
    void look(Viewpoint viewpoint);
    /// Renders one more frame even if nothing has changed.
    void again();
    /// Sets the time of the scene's animation clips, s.
    void go_to(double scene_s);

    /// Newest frame that all ranks have; null before the first.
    std::shared_ptr<LiveFrame const> newest() const;
    /// Edits of objects and lights that were posted and are not in the frame, which is one of the last two, oldest
    /// first.
    std::vector<Change> edits_since(LiveFrame const& frame) const;
    /// On a rank that follows: a frame that all ranks have, and none before it from then on; null: it was not rendered.
    std::shared_ptr<LiveFrame const> frame(std::uint64_t number);
    /// True if no frame is being rendered or due: `newest` stays until something changes.
    /// Always false on a follower.
    bool rests() const;
    /// Waits for a frame that began after this call, and so includes all earlier posts; null on timeout or stop.
    std::shared_ptr<LiveFrame const> next_frame(double timeout_s);
    bool stopped() const { return stopped_; } ///< the thread has ended, e.g. a follower whose leader ended
    void stop();

private:
    void run();
    void run_linked();
    void run_leading();
    void run_following();
    void do_jobs();
    bool scene_may_move(Viewpoint const& now) const;
    bool anything_moves(Viewpoint const& now) const;
    void choose_updated_axes(bool may_move);
    void measure(FrameWork const& work, FrameBudget const& budget);
    FrameCommand make_command(Viewpoint const& now, bool still, FrameBudget& budget);
    double seen_after_s() const;
    void add_margins(FrameCommand& command, Viewpoint const& last) const;
    enum class Rendered : std::uint8_t { whole, failed, given_up };
    Rendered render(FrameCommand command, FrameBudget const& budget, double ahead_s = 0);
    void publish(std::shared_ptr<LiveFrame const> frame);
    void exchange_light(LiveFrame& frame);
    void wait_until(double time_s);

    RenderSession& session_;
    SessionClock const& clock_;
    FrameLink* link_;
    Hooks hooks_;

    mutable std::mutex mutex_;
    std::condition_variable wake_, published_;
    std::deque<std::function<void()>> jobs_;
    Viewpoint viewpoint_;
    Anticipation anticipation_;
    std::atomic<bool> looked_{false}; ///< a frame is wanted, as of a viewpoint that changed since the current one began
    bool asked_ = false;              ///< the viewpoint changed since then, or a change was posted
    std::shared_ptr<gi::StopRequest> stop_; ///< of the frame that is rendered, if it may be given up
    bool refines_ = false;                  ///< it is of a viewpoint at rest
    struct Edit {
        std::uint64_t number; ///< counted from 1
        Change change;
    };
    std::deque<Edit> edits_;        ///< posted since the last frame but one
    std::uint64_t count_edits_ = 0; ///< so far
    std::shared_ptr<LiveFrame const> newest_;
    std::deque<std::shared_ptr<LiveFrame const>> frames_; ///< not shown yet, on a rank that follows
    bool resting_ = false;
    std::atomic<bool> quit_{false}, stopped_{false};

    // Used only by the rendering thread
    Governor governor_;
    UpdateGovernor update_governor_;
    int stored_ = 0;               ///< stored axes in the last measured frame
    std::uint64_t made_edits_ = 0; ///< number of the last one that was applied or refused
    std::vector<Change> changes_;
    FrameCommand last_;
    Viewpoint last_look_;                         ///< of the last frame, before extrapolation
    std::uint64_t adopted_ = 0;                   ///< number of scenes so far
    bool has_last_ = false, awaits_look_ = false; ///< awaits_look_: at a new scene
    double scene_s_ = 0, last_begun_s_ = 0;
    double last_scene_s_ = 0; ///< scene_s_ in the last frame
    double ahead_s_ = 0;      ///< its command's scene_s is that of so much later
    double frame_s_ = 0;      ///< time that frames take, smoothed
    std::uint64_t frame_ = 0;
    std::uint32_t still_paths_ = 0;
    int settled_ = 0;   ///< frames since anything moved
    int rests_for_ = 0; ///< looks in a row that found nothing to render
    std::thread thread_;
};

} // namespace viewer
