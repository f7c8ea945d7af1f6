#pragma once
// The change "scene": which scene is shown next, and for which camera and how many pixels its method is started.
// The latter decide what the method builds (the plan of slhb), so recordings and ranks have them:
//   "atrium"                                     a name alone: the method starts with the next frame's views
//   {"file": "atrium", "start": {"pixels": ..., "world_from_camera": [16 numbers], "yfov_rad": ...},
//    "files": {"room.obj": "c0ffee...", ...}}     with the files that it was read from (scene_files.h), if it is recorded

#include "viewer/engine/scene_files.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

struct SceneStart {
    gi::Camera camera;
    double pixels = 0; ///< of all views of a frame, at full size

    bool operator==(SceneStart const&) const = default;
};

struct SceneChange {
    std::string name;
    std::optional<SceneStart> start;
    FileHashes files{}; ///< only of what is recorded
};

/// With all bits of the numbers.
nlohmann::json to_json(SceneStart const& start);
/// Throws InputError if it is none, or if the camera could not be one of a frame command.
SceneStart start_from_json(nlohmann::json const& value);

Change to_change(SceneChange const& change);
/// Throws InputError.
SceneChange scene_change_of(Change const& change);

} // namespace viewer
