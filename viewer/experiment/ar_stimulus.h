#pragma once
// A stimulus from an AR session: its settings `ar` and `ar.KEY`, and what of them decides the pictures.

#include "ar/scene/session_file.h"
#include "gi/core/error.h"
#include "study/script/script.h"

namespace viewer {

enum class ArShow {
    composite, ///< with the virtual things
    camera,    ///< the camera's frames
    truth      ///< pictures of the same frames with the things really there
};

struct ArStimulus {
    std::filesystem::path session;      ///< the file
    std::optional<std::uint64_t> frame; ///< by its number, the only one that is seen; none = it plays
    double from_s = 0;                  ///< from this moment of the session on
    ArShow show = ArShow::composite;
    std::filesystem::path truth; ///< folder of pictures 000012.png, by numbers of frames
    std::filesystem::path poses; ///< in place of markers; empty = none
    study::Patch overrides;      ///< "render.paths": "4", over what the file says
    std::string text;            ///< the session with them, as YAML
};

/// One of the settings `ar` and `ar.KEY` cannot be so.
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

/// Of the settings that begin with `ar`. @param folder  that the session's file is relative to
/// @throws ArSettingError; gi::InputError with file:line:column for what is wrong within the session's file
ArStimulus ar_stimulus(study::Patch const& patch, std::filesystem::path const& folder);
ArSession session_of(ArStimulus const& stimulus);

/// Of the bytes of everything that the session names: its frames, calibration, maps, scenes; of poses and truth.
std::string content_hash(ArStimulus const& stimulus);

} // namespace viewer
