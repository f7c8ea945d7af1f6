#pragma once
// Reads parts of a session file, and values that occur in several of them. All throw gi::InputError with
// file:line:column.

#include "ar/scene/session_file.h"
#include "gi/core/yaml.h"

#include <utility>

namespace ar {

/// Returns the value of the matching word.
template <class T>
T choice(gi::Yaml const& at, std::vector<std::pair<char const*, T>> const& words)
{
    std::string const text = at.text();
    std::string known;
    for (auto const& [word, value] : words) {
        if (text == word) return value;
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    throw at.error("'" + text + "' is not known here", "nothing could be done with it", "choose one of " + known);
}

/// True if the name is a device for open_source, not a path.
bool is_device(std::string const& source);
/// Reads the key `file_key`, relative to the folder, with `at`, `turn_deg` and `scale`; ignores other keys.
PlacedScene read_placed(gi::Yaml const& map, std::string const& file_key, std::filesystem::path const& folder);
/// Reads `position_m`, and `rotation_deg` (about x, then y, then z) or `rotation_xyzw`, as in marker maps.
gi::RigidPose read_pose(gi::Yaml const& map);
/// The same, without other keys; the rotation stays as it is where none is given.
void read_turned(gi::Yaml const& map, gi::RigidPose& pose);

/// Reads the key `real`: the modelled part of the real place.
RealPlace read_real(gi::Yaml const& real, std::filesystem::path const& folder);
/// Reads the key `hmd`.
HmdCameras read_hmd(gi::Yaml const& hmd, std::filesystem::path const& folder);

} // namespace ar
