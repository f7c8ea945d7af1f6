#pragma once
// Values that several parts of a session file have.

#include "ar/scene/proxies.h"
#include "gi/core/yaml.h"

#include <utility>

namespace viewer {

/// One of these words.
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

/// A name that ar::open_source takes as it is, not a path.
bool is_device(std::string const& source);
/// Of the key `file_key`, relative to the folder, with `at`, `turn_deg` and `scale`; other keys are not looked at.
ArPlaced read_placed(gi::Yaml const& map, std::string const& file_key, std::filesystem::path const& folder);
/// Of `position_m`, and `rotation_deg` (about x, then y, then z) or `rotation_xyzw`; as marker maps have them.
ar::Pose read_pose(gi::Yaml const& map);

} // namespace viewer
