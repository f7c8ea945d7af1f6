#pragma once
// Renders a recording again, off-screen: bit by bit as it was, or with other settings.

#include "gi/core/progress.h"
#include "viewer/app/replayed_eyes.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/engine/render_session.h"
#include "viewer/protocol/recording/recording.h"

namespace viewer {

struct ReplayOptions {
    std::string file;
    std::vector<Change> settings;   ///< override the recorded settings throughout
    int paths = 0;                  ///< per pixel; 0 = as recorded
    std::optional<glm::ivec2> size; ///< of the pictures that are written, and so of the views
    ReplayedEyes eyes = ReplayedEyes::window;
    std::string out;   ///< pattern of EXR or PNG frames; empty = none
    std::string video; ///< of the same, at `fps`
    double fps = 30;
    int threads = 0;
    bool shown = false; ///< what was shown instead of what was rendered, drawn by OpenGL
};

struct ReplaySummary {
    std::string program; ///< that recorded it, with its level of processors and its Embree
    std::uint64_t frames = 0, same = 0, other = 0, unknown = 0; ///< compared with the recorded pixel hashes
    std::optional<std::uint64_t> first_other;
    std::uint64_t shown = 0, shown_same = 0, shown_other = 0; ///< pictures drawn; compared with their hashes
    std::optional<std::uint64_t> first_shown_other;           ///< its number, from 0
    std::vector<std::string> changed_files;                   ///< of the scenes, since the recording
    RecordingEnd end;
    bool interrupted = false;
};

/// Functions that load and animate the scenes of a recording.
struct RecordedScenes {
    LoadScene load;
    DriveBodies drive; ///< empty = scenes are moved only by their animation clips
    std::vector<AvatarOfUser> avatars;
};
/// Makes them from RecordingHeader::settings["load"].
using LoadRecorded = std::function<RecordedScenes(nlohmann::json const& load)>;

/// True if no option changes the recorded settings, so that pixels must be equal.
bool as_recorded(ReplayOptions const& options);

/// Throws InputError if something cannot be read, rendered or written.
ReplaySummary replay(ReplayOptions const& options, LoadRecorded const& load, gi::StopRequest const& stop,
                     gi::Report& report);

} // namespace viewer
