#pragma once
// `lightwell view`: windows, input, remote control, recording, and the thread that renders. The loop of the main
// thread never waits for a picture: it takes input, tells the renderer where the user is, and shows what there is.

#include "gi/base/progress.h"
#include "viewer/gl/panel.h"
#include "viewer/gl/swap_timer.h"
#include "viewer/recording/frame_log.h"
#include "viewer/recording/recording.h"
#include "viewer/remote/remote_server.h"
#include "viewer/show/controls.h"
#include "viewer/show/live_error.h"
#include "viewer/show/presenter.h"

namespace viewer {

struct ViewOptions {
    LoadScene load;
    std::string scene;
    std::function<gi::Camera(gi::World const&)> first_camera; ///< where a scene is looked at from at first
    std::vector<Change> settings;                             ///< set before the first frame
    glm::ivec2 size_px{1280, 720};
    std::string monitor; ///< full screen there; empty = a window
    int swap_interval = 1;
    int threads = 0;
    NavigationMode navigation = NavigationMode::fly;
    std::string screenshots; ///< folder of those taken by key
    std::filesystem::path record, frame_log;
    RecordingHeader header;      ///< of the recording, but for its settings
    nlohmann::json load_options; ///< what load needs to know besides the scene's name, for replays
    RemoteOptions remote;
    double time_limit_s = 0; ///< 0 = none
};

struct ViewSummary {
    FrameSummary frames;
    std::uint64_t rendered = 0, recorded = 0, presented = 0;
    double longest_block_ms = 0; ///< of the main thread: between two looks at the input
    std::string gl;
};

/// Until the user, the remote control, the limit or `stop` ends it. Throws InputError on what cannot be opened.
ViewSummary run_view(ViewOptions const& options, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
