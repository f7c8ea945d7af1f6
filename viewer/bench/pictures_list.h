#pragma once
// The scenes of `lightwell bench pictures`, from a YAML file:
//
//   scenes:
//     - {name: cornell, built_in: cornell}
//     - {name: hall, file: hall.glb, camera: door, envmap: sky.hdr, envmap_rotate: 90}
//
// Keys: name; file (beside the list) or built_in; camera, look_from, look_at, fov, time, envmap (beside the list),
// envmap_rotate, envmap_scale, which mean what the options of `lightwell render` mean. Scenes in which something
// moves stand in a list `sequences`; they may have a camera_path (beside the list), and stand still where they
// have a time.

#include "viewer/offline/render_options.h"

#include <filesystem>

namespace viewer {

struct ListedScene {
    std::string name;
    RenderOptions options; ///< the common ones, with scene and point of view set
    std::string missing;   ///< a file that is not there; empty = none
};

enum class Listed : std::uint8_t { scenes, sequences };

/// @param common  options that all scenes have
/// Throws InputError with file:line:column.
std::vector<ListedScene> read_scene_list(std::filesystem::path const& file, RenderOptions const& common,
                                         Listed which = Listed::scenes);
/// Those with these names, in this order; all where no name is given. A name that the list does not have is a
/// built-in scene or a file, as for lightwell render. Throws InputError where it is neither, naming those of the
/// list.
std::vector<ListedScene> choose_scenes(std::vector<ListedScene> list, std::vector<std::string> const& names,
                                       RenderOptions const& common);

} // namespace viewer
