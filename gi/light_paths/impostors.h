#pragma once
// Draws distance impostors of a world with the project's rasteriser: six faces around each centre, hidden surfaces
// removed. Of surfaces that are partly transparent a texel holds what is there at its centre; where coverage is
// partial that is a random decision for each texel, and not, as for exact rays, for each ray.

#include "gi/core/progress.h"
#include "gi/light_paths/impostor_maps.h"
#include "gi/light_paths/settings.h"
#include "gi/raster/cut_outs.h"
#include "gi/render/render_settings.h"

#include <span>

namespace gi {

/// Texels along an edge of a face: what is asked for, rounded up to whole blocks.
std::uint32_t impostor_resolution(int texels);
/// Upper bound of the memory of impostors. @param moves  whether some triangles can move
std::uint64_t impostor_bytes(int count, int texels, bool moves);
/// Throws InputError for more than kMostBytes (memory_limit.h), those by hand too.
void check_impostors(PhotonSettings const& settings, bool moves);

/// Distance of the faces' near planes, m: as near to the centre as the precision of floats allows.
float impostor_near(World const& world, vec3 centre);

/// Impostors in host memory, which follow moving geometry.
class Impostors {
public:
    /// @param centres  finite, in the world's coordinates; else InputError  @param resolution  texels along an
    /// edge of a face, 1 to 4096  @param seed  of the random decisions about partial coverage
    /// @param world  must outlive it
    /// @param first_moving  index of the first triangle that may move; all later ones may move too
    /// @param stop  checked while they are drawn, which throws Interrupted
    Impostors(World const& world, std::vector<vec3> centres, std::uint32_t resolution, std::uint32_t seed = 0,
              std::size_t first_moving = ~std::size_t(0), BuildStop const& stop = BuildStop(nullptr));

    /// Draws the triangles that may move again. Materials must not have changed.
    void moved(World const& world);

    ImpostorsView view() const { return {centres_, texels_, blocks_, resolution_}; }

private:
    void draw(World const& world, std::size_t first, std::size_t last, bool keep_nearer, BuildStop const& stop);

    std::vector<vec3> centres_;
    std::vector<ImpostorTexel> texels_, still_; ///< still_: of what does not move; empty if nothing does
    std::vector<ImpostorBlock> blocks_;
    std::uint32_t resolution_, seed_;
    TriangleSoup soup_;
    CutOuts cut_outs_;
    std::size_t first_moving_;
};

} // namespace gi
