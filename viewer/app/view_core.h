#pragma once
// The parts of a viewer that do not depend on the output device: the session and its rendering thread, settings
// and commands, remote control, recording and frame log.

#include "viewer/app/requests.h"
#include "viewer/app/view_program.h"
#include "viewer/protocol/recording/frame_log.h"
#include "viewer/protocol/recording/recording.h"
#include "viewer/protocol/remote/remote_server.h"

#include <set>

namespace viewer {

class ViewCore {
public:
    /// Loads the scene and opens sockets. Throws InputError. All arguments must outlive it.
    ViewCore(ViewOptions const& options, gi::Report& report);
    ~ViewCore();

    /// Creates the output files, after all checks that may fail, and starts rendering. Throws InputError.
    /// @param link  null without other ranks   @param published  called on the rendering thread
    void start(FrameLink* link, std::function<void()> published,
               std::function<std::vector<ViewCommand>(FrameCommand const&)> own_views = {});
    /// Handles answers from the rendering thread, tapped keys and sockets. Returns false when the viewer should
    /// end.
    bool poll(gi::StopRequest const& stop);
    /// Executes a command, except selecting and dragging.
    void obey(Command command);
    void log(FrameTimes const& times);
    /// Ends the rendering thread and closes files.
    void finish();

    /// Saves a screenshot requested by key: the window's bytes, and all layers of its first view.
    void save_screenshot(glm::ivec2 window_px, std::vector<unsigned char> const& bytes);

    ViewOptions const& options;
    std::optional<Display> display; ///< adapted to the capabilities of the windows
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
    /// Reports each file that can no longer be written, once.
    void watch_files();
    void report_failure(std::filesystem::path const& file, std::string const& why);
    void reset_view(); ///< to the first camera of a newly loaded scene

    std::unique_ptr<RemoteServer> remote_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<FrameLog> log_;
    FrameStatistics frames_;                    ///< of all frames, whether they are logged or not
    std::set<std::filesystem::path> unwritten_; ///< files that could not be completed
    double last_poll_s_ = 0;
};

} // namespace viewer
