#pragma once
// `lightwell view`: windows on a desktop or the walls of a display. The main loop never waits for a picture: it
// reads input, passes the users' poses to the renderer, and shows the newest frame.

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
    DriveBodies drive;                 ///< moves the avatars that `load` added to the scene; empty = none
    std::vector<AvatarOfUser> avatars; ///< moved by `drive`
    std::string scene;
    std::function<gi::Camera(gi::World const&)> first_camera; ///< start camera of a scene
    std::vector<Change> settings;                             ///< set before the first frame
    glm::ivec2 size_px{1280, 720};
    std::vector<std::string> monitors; ///< for full screen, one per window; empty = windowed
    int swap_interval = 1;
    int threads = 0;
    NavigationMode navigation = NavigationMode::fly;
    double eye_height_m = 1.6; ///< of the first user above the floor; a headset measures it
    std::string screenshots;   ///< file-name prefix of screenshots taken by key
    std::optional<Display> display;
    std::optional<study::DisplayModel> display_model; ///< of the desktop's windows: pictures are linear in light
    std::filesystem::path record, frame_log;
    bool hash_shown = false;     ///< the recording has hashes of what is shown
    RecordingHeader header;      ///< of the recording, without the settings
    nlohmann::json load_options; ///< options of `load` besides the scene's name, for replays
    RemoteOptions remote;
    double time_limit_s = 0; ///< 0 = none
    int rank = -1;           ///< in a cluster; -1 = no cluster
};

struct ViewRunSummary {
    FrameSummary frames;
    std::uint64_t rendered = 0, recorded = 0, presented = 0;
    bool files_whole = true;     ///< recording and frame log are complete
    double longest_block_ms = 0; ///< longest time between two reads of input on the main thread
    std::string gl;
    double exposure_ev = 0; ///< of the last frame
    std::string schedule;   ///< what the plan chose for the last frame and why; empty = nothing
    nlohmann::json trackers, headset;
};

/// Runs until the user, the remote control, the time limit or `stop` ends it. Throws InputError if something
/// cannot be opened. @param link  to the other ranks; null if there are none
ViewRunSummary run_view(ViewOptions const& options, FrameLink* link, gi::StopRequest const& stop,
                        gi::Report& report);

} // namespace viewer
