#pragma once
// `lightwell view`: windows on a desktop or the walls of a display. The loop of the main thread never waits for a
// picture: it takes input, tells the renderer where the users are, and shows what there is.

#include "gi/core/progress.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/displays/display.h"
#include "viewer/engine/live/live_renderer.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/protocol/recording/frame_summary.h"
#include "viewer/protocol/recording/recording.h"
#include "viewer/protocol/remote/remote_server.h"

namespace viewer {

struct ViewOptions {
    LoadScene load;
    DriveBodies drive; ///< moves the avatars that `load` has added to the scene; empty = there are none
    std::vector<AvatarOfUser> avatars; ///< that `drive` moves
    std::string scene;
    std::function<gi::Camera(gi::World const&)> first_camera; ///< where a scene is looked at from at first
    std::vector<Change> settings;                             ///< set before the first frame
    glm::ivec2 size_px{1280, 720};
    std::vector<std::string> monitors; ///< full screen there, one for each window; empty = windows
    int swap_interval = 1;
    int threads = 0;
    NavigationMode navigation = NavigationMode::fly;
    double eye_height_m = 1.6; ///< of the first user above the floor; a headset says it itself
    std::string screenshots;   ///< prefix of those taken by key
    std::optional<Display> display;
    std::filesystem::path record, frame_log;
    RecordingHeader header;      ///< of the recording, but for its settings
    nlohmann::json load_options; ///< what load needs to know besides the scene's name, for replays
    RemoteOptions remote;
    double time_limit_s = 0; ///< 0 = none
    int rank = -1;           ///< of a cluster; -1 = alone
};

struct ViewRunSummary {
    FrameSummary frames;
    std::uint64_t rendered = 0, recorded = 0, presented = 0;
    bool files_whole = true;     ///< recording and frame log have all that came
    double longest_block_ms = 0; ///< of the main thread: between two looks at the input
    std::string gl;
    std::string schedule; ///< of slhb: the one in use in the last frame and why; empty of other methods
    nlohmann::json trackers, headset;
};

/// Until the user, the remote control, the limit or `stop` ends it. Throws InputError on what cannot be opened.
/// @param link  to the other ranks; null where there are none
ViewRunSummary run_view(ViewOptions const& options, FrameLink* link, gi::StopRequest const& stop,
                        gi::Report& report);

} // namespace viewer
