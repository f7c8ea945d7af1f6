#pragma once
// The parts of a viewer that do not depend on the output device: the session and its rendering thread, settings
// and commands, remote control, recording and frame log.

#include "viewer/app/auto_exposure.h"
#include "viewer/app/requests.h"
#include "viewer/app/view_program.h"
#include "viewer/protocol/recording/frame_log.h"
#include "viewer/protocol/recording/recording.h"
#include "viewer/protocol/remote/remote_server.h"

#include <future>
#include <set>

namespace viewer {

/// Surfaces are drawn for newer poses unless told otherwise.
ViewOptions with_surfaces(ViewOptions options);

class ViewCore {
public:
    /// Applies the settings and opens sockets. Throws InputError. All arguments must outlive it.
    ViewCore(ViewOptions const& options, gi::Report& report);
    ~ViewCore();

    /// Starts the rendering thread and begins to load the scene. The output files are created when it is ready.
    /// Throws InputError if one exists already.
    /// @param link  null without other ranks   @param published  called on the rendering thread
    /// @param pixels  of all views of a frame, about; the method's start is planned for them
    void start(FrameLink* link, std::function<double()> pixels, std::function<void()> published,
               std::function<std::vector<ViewCommand>(FrameCommand const&)> own_views = {});
    /// Handles answers from the rendering thread, tapped keys and sockets.
    /// Returns false when the viewer should end.
    bool poll(gi::StopRequest const& stop);
    /// Passes the users' views on to the rendering thread.
    void look(Viewpoint viewpoint);
    /// A fresh frame is shown: automatic exposure follows it.
    void expose(LiveFrame const& frame);
    /// Executes a command, except selecting and dragging.
    void obey(Command command);
    void log(FrameTimes const& times);
    /// Records what was shown, if there is a recording.
    void note_shown(ShownFrame const& shown);
    /// Ends the rendering thread and closes files. Throws what kept the first scene from being shown.
    void finish();

    /// Saves a screenshot requested by key, in the background: what is shown, and all layers of each view.
    void save_screenshot(Snapshot shown);

    bool keeps_recent = false; ///< scene files that are shown are kept among the recent ones

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
    void load(std::string const& name, std::function<void(std::string const&)> done);
    /// Called for a scene that is shown from now on.
    void loaded(SceneFacts const& facts, SceneChange const& scene);
    void not_loaded(std::exception_ptr const& failure, std::function<void(std::string const&)> const& done);
    void show_progress();
    void check_files() const;
    void make_files(SceneChange const& scene);
    /// Reports each file that can no longer be written, once.
    void watch_files();
    void report_failure(std::filesystem::path const& file, std::string const& why);

    std::function<double()> pixels_;
    std::exception_ptr failure_; ///< of the first scene
    std::uint64_t resumes_ = 0;  ///< scene that the next look is at, if it is a new one
    std::unique_ptr<gi::ProgressBar> bar_;
    /// The step of the current frame, from the rendering thread.
    struct FrameStep {
        std::mutex mutex;
        gi::Step step;
        double begun_s = -1; ///< of the frame; -1 = none is being rendered
    } frame_step_;
    std::unique_ptr<RemoteServer> remote_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<FrameLog> log_;
    FrameStatistics frames_;                    ///< of all frames, whether they are logged or not
    std::set<std::filesystem::path> unwritten_; ///< files that could not be completed
    double last_poll_s_ = 0;
    std::vector<std::future<void>> saving_;
    AutoExposure auto_exposure_;
    SceneLoader loader_; ///< ends first
};

} // namespace viewer
