#pragma once
// What an OpenXR runtime and its headset say of themselves.

#include <string>
#include <vector>

namespace viewer {

struct HmdInfo {
    std::string runtime;         ///< name and version
    std::string system;          ///< the headset
    std::string graphics;        ///< how pictures go there: "GLX", "EGL"; empty where none do
    std::string space;           ///< "stage", "local, eyes 1.6 m above the floor"
    int width = 0, height = 0;   ///< recommended pixels per eye
    int widest = 0, highest = 0; ///< at most
    bool tracks_position = false, tracks_rotation = false;
    std::vector<std::string> blend_modes;        ///< "opaque", "additive", "alpha blend"; the first is used
    std::vector<std::string> extensions_used;    ///< of those that lightwell knows
    std::vector<std::string> extensions_missing; ///< likewise, each with what does not work without it
};

/// Asks the runtime without starting a session. Throws InputError where there is no runtime or no headset.
HmdInfo ask_runtime();

} // namespace viewer
