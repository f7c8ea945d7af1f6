#pragma once
// What a viewer has whatever it shows its pictures on: the session and its rendering thread, settings and
// commands, remote control, recording and the log of frames.

#include "viewer/app/requests.h"
#include "viewer/app/view_program.h"
#include "viewer/protocol/recording/frame_log.h"
#include "viewer/protocol/recording/recording.h"
#include "viewer/protocol/remote/remote_server.h"

#include <set>

namespace viewer {

class ViewCore {
public:
    /// Loads the scene, opens sockets. Throws InputError. All arguments outlive it.
    ViewCore(ViewOptions const& options, gi::Report& report);
    ~ViewCore();

    /// Makes the files that are written, after everything that can be refused; begins to render. Throws
    /// InputError.
    /// @param link  null where this process is alone   @param published  called on the rendering thread
    void start(FrameLink* link, std::function<void()> published,
               std::function<std::vector<ViewCommand>(FrameCommand const&)> own_views = {});
    /// Answers from the rendering thread, taps, sockets. False where it is time to end.
    bool poll(gi::StopRequest const& stop);
    /// What a key or button means, but for selecting and dragging.
    void obey(Command command);
    void log(FrameTimes const& times);
    /// Ends the thread, closes files.
    void finish();

    /// A screenshot by key: the window's bytes, and all layers of its first view.
    void save_screenshot(glm::ivec2 window_px, std::vector<unsigned char> const& bytes);

    ViewOptions const& options;
    std::optional<Display> display; ///< as far as the windows can show it
    gi::Report& report;
    ViewState state;
    RenderSession session;
    Controls controls;
    Requests requests;
    std::unique_ptr<LiveRenderer> renderer;
    ViewRunSummary summary;

private:
    void start_at(gi::Camera const& camera);
    void make_files();
    /// Tells once of each file that cannot be written any more.
    void watch_files();
    void report_failure(std::filesystem::path const& file, std::string const& why);
    void reset_view(); ///< at a scene that was loaded, from its first camera

    std::unique_ptr<RemoteServer> remote_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<FrameLog> log_;
    std::set<std::filesystem::path> unwritten_; ///< not to their end
    double last_poll_s_ = 0;
};

} // namespace viewer
