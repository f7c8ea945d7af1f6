#pragma once
// The scenes of `lightwell bench pictures`, from a YAML file:
//
//   scenes:
//     - {name: cornell, built_in: cornell}
//     - {name: hall, file: hall.glb, camera: door, envmap: sky.hdr, envmap_rotate: 90}
//
// Keys: name; file (beside the list) or built_in; camera, look_from, look_at, fov, time, envmap (beside the list),
// envmap_rotate, envmap_scale, which mean what the options of `lightwell render` mean.

#include "viewer/render_options.h"

#include <filesystem>

namespace viewer {

struct ListedScene {
    std::string name;
    RenderOptions options; ///< the common ones, with scene and point of view set
    std::string missing;   ///< a file that is not there; empty = none
};

/// @param common  options that all scenes have
/// Throws InputError with file:line:column.
std::vector<ListedScene> read_scene_list(std::filesystem::path const& file, RenderOptions const& common);
/// Those with these names, in this order; all where no name is given. Throws InputError naming the known ones.
std::vector<ListedScene> choose_scenes(std::vector<ListedScene> list, std::vector<std::string> const& names);

} // namespace viewer
