#pragma once
// A recording rendered again, off-screen: as it was, bit for bit, or at any other quality.

#include "gi/core/progress.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/engine/render_session.h"
#include "viewer/protocol/recording/recording.h"

namespace viewer {

struct ReplayOptions {
    std::string file;
    std::vector<Change> settings;            ///< in place of what was set then, all the time
    int paths = 0;                           ///< per pixel; 0 = as then
    std::optional<std::pair<int, int>> size; ///< of every view, pixels
    std::string out;                         ///< pattern of EXR or PNG frames of the first view; empty = none
    std::string video;                       ///< of the first view, at `fps`
    double fps = 30;
    int threads = 0;
};

struct ReplaySummary {
    std::uint64_t frames = 0, same = 0, other = 0, unknown = 0; ///< against the pixels of then
    std::optional<std::uint64_t> first_other;
    RecordingEnd end;
    bool interrupted = false;
};

/// What a recording's scenes are read and moved with.
struct RecordedScenes {
    LoadScene load;
    DriveBodies drive; ///< empty = nothing but their clips moves them
    std::vector<AvatarOfUser> avatars;
};
/// From RecordingHeader::settings["load"].
using LoadRecorded = std::function<RecordedScenes(nlohmann::json const& load)>;

/// True where nothing is rendered otherwise than then, so that pixels must be the same.
bool as_recorded(ReplayOptions const& options);

/// Throws InputError on what cannot be read, rendered or written.
ReplaySummary replay(ReplayOptions const& options, LoadRecorded const& load, gi::StopRequest const& stop,
                     gi::Report& report);

} // namespace viewer
