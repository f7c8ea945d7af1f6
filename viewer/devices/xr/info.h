#pragma once
// Properties reported by an OpenXR runtime and its headset.

#include <string>
#include <vector>

namespace viewer {

struct HmdInfo {
    std::string runtime;         ///< name and version
    std::string system;          ///< the headset
    std::string graphics;        ///< graphics binding: "GLX", "EGL"; empty without pictures
    std::string space;           ///< "stage", "local, eyes 1.6 m above the floor"
    int width = 0, height = 0;   ///< recommended pixels per eye
    int widest = 0, highest = 0; ///< at most
    int inset_width = 0, inset_height = 0; ///< recommended pixels of the middle of each eye; 0 = no insets
    bool tracks_position = false, tracks_rotation = false;
    bool tracks_gaze = false;                    ///< if the extension is used
    std::vector<std::string> blend_modes;        ///< e.g. "opaque", "additive", "alpha blend"; the first is used
    std::vector<std::string> extensions_used;    ///< of those known to lightwell
    std::vector<std::string> extensions_missing; ///< likewise, each with the feature that is missing without it
};

/// Queries the runtime without starting a session. Throws InputError if there is no runtime or no headset.
HmdInfo ask_runtime();

} // namespace viewer
