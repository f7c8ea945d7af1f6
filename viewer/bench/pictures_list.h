#pragma once
// The scenes of `lightwell bench pictures`, from a YAML file:
//
//   scenes:
//     - {name: cornell, built_in: cornell}
//     - {name: hall, file: hall.glb, camera: door, envmap: sky.hdr, envmap_rotate: 90}
//
// Keys: name; file (beside the list) or built_in; camera, look_from, look_at, fov, time, envmap (beside the list),
// envmap_rotate, envmap_scale; they correspond to the options of `lightwell render`. Moving scenes are in a list
// `sequences`; they may have a camera_path (beside the list). With a time, their scene does not move.

#include "viewer/offline/render_options.h"

#include <filesystem>

namespace viewer {

struct ListedScene {
    std::string name;
    RenderOptions options; ///< the common options, with scene and camera set
    std::string missing;   ///< a missing file; empty = none
};

enum class Listed : std::uint8_t { scenes, sequences };

/// Reads the list. @param common  options of all scenes
/// Throws InputError with file:line:column.
std::vector<ListedScene> read_scene_list(std::filesystem::path const& file, RenderOptions const& common,
                                         Listed which = Listed::scenes);
/// Returns the scenes with these names, in this order; all if no name is given.
/// A name that is not in the list can be a built-in scene or a file, as for lightwell render.
/// Throws InputError if it is neither, listing the names of the list.
std::vector<ListedScene> choose_scenes(std::vector<ListedScene> list, std::vector<std::string> const& names,
                                       RenderOptions const& common);

} // namespace viewer
