#pragma once
// A stimulus from an AR session: its settings `ar` and `ar.KEY`, and the data that determine its pictures.

#include "ar/scene/session_file.h"
#include "gi/core/error.h"
#include "study/script/script.h"

namespace viewer {

enum class ArShow {
    composite, ///< with the virtual objects
    camera,    ///< the camera's frames
    truth      ///< reference pictures: the same frames with the real objects
};

struct ArStimulus {
    std::filesystem::path session;      ///< the file
    std::optional<std::uint64_t> frame; ///< number of a single frame to show; none = plays as a sequence
    double from_s = 0;                  ///< start time in the session
    ArShow show = ArShow::composite;
    std::filesystem::path truth; ///< folder of pictures named by frame number, 000012.png
    std::filesystem::path poses; ///< file of camera poses, used instead of markers; empty = none
    study::Patch overrides;      ///< "render.paths": "4", replace values in the file
    std::string text;            ///< the session with the overrides, as YAML
};

/// One of the settings `ar` and `ar.KEY` is invalid.
class ArSettingError : public gi::InputError {
public:
    ArSettingError(std::string key_, std::string value_, std::string const& problem, std::string const& why,
                   std::string const& suggestion)
        : gi::InputError(problem, why, suggestion), key(std::move(key_)), value(std::move(value_))
    {
    }
    std::string key, value; ///< as written
};

bool is_ar_setting(std::string const& key);

/// Builds a stimulus from the settings that begin with `ar`. @param folder  base folder of the session's path
/// @throws ArSettingError; gi::InputError with file:line:column for errors within the session's file
ArStimulus ar_stimulus(study::Patch const& patch, std::filesystem::path const& folder);
ar::Session session_of(ArStimulus const& stimulus);

} // namespace viewer
