#pragma once
// The place as it is modelled: the session's scene file and its proxies, in the world of the markers.

#include "ar/scene/albedo_file.h"
#include "ar/scene/session_file.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

namespace viewer {

/// A material whose albedo is estimated: numbers of AlbedoView::surface.
struct AlbedoPatch {
    std::string name;                 ///< of AlbedoEntry
    std::size_t material = 0;         ///< of the scene
    int texels = 0;                   ///< on the longer side of a texture; 0 = one colour
    double width_m = 1, height_m = 1; ///< of what the texture covers, for its shape
};

struct RealScene {
    gi::Scene scene;
    std::vector<AlbedoPatch> patches;
};

/// Everything, with grey where albedos are to be estimated.
RealScene model_of(ArReal const& real, gi::Report& report);
/// Gives patches what was found. Those never seen (no samples) are counted. @throws gi::InputError a patch of
/// which nothing is said
void take_albedos(RealScene& real, std::vector<AlbedoEntry> const& entries, std::filesystem::path const& file,
                  gi::Report& report);
/// Both. @throws gi::InputError albedos are to be estimated, and there is no file of estimates
gi::Scene real_scene(ArReal const& real, gi::Report& report);

} // namespace viewer
