#pragma once
// Builds the model of the real place: the session's scene file and its proxies, in the world of the markers.

#include "ar/scene/albedo_file.h"
#include "ar/scene/session_file.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

namespace ar {

/// A material whose albedo is estimated; its index is the patch number in AlbedoView::surface.
struct AlbedoPatch {
    std::string name;                 ///< name in AlbedoEntry
    std::size_t material = 0;         ///< index in the scene
    int texels = 0;                   ///< longer side of the texture; 0 = one colour
    double width_m = 1, height_m = 1; ///< area that the texture covers, for its aspect ratio
};

struct RealScene {
    gi::Scene scene;
    std::vector<AlbedoPatch> patches;
};

/// Returns the whole model, with grey for albedos to be estimated.
RealScene model_of(RealPlace const& real, gi::Report& report);
/// Sets the patches' albedos from the entries; patches never seen (no samples) are counted. @throws gi::InputError
/// a patch without an entry
void take_albedos(RealScene& real, std::vector<AlbedoEntry> const& entries, std::filesystem::path const& file,
                  gi::Report& report);
/// Both steps. @throws gi::InputError if albedos are to be estimated and the file of estimates is missing
gi::Scene real_scene(RealPlace const& real, gi::Report& report);

} // namespace ar
