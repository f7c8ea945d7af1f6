#include "gi/methods/paths/lobes.h"

#include "gi/scene/shading/narrow_lobes.h"

namespace gi {

bool narrow_somewhere(World const& world)
{
    std::vector<bool> used(world.materials.size(), false);
    for (std::uint32_t const m : world.triangle_material) used[m] = true;
    for (std::size_t m = 0; m < used.size(); ++m) {
        if (!used[m]) continue;
        Material const& material = world.materials[m];
        if (has_narrow_lobe(world.bsdfs[m])) return true;
        bool const textured = material.metallic_roughness_map.texture >= 0 ||
                              material.transmission_map.texture >= 0 || material.specular_map.texture >= 0;
        // A roughness map can reduce any roughness.
        if (textured && (material.specular > 0 || material.metallic > 0 || material.transmission > 0)) return true;
    }
    return false;
}

bool smooth_somewhere(World const& world)
{
    for (std::size_t k = 0; k < world.materials.size(); ++k) {
        Material const& m = world.materials[k];
        Bsdf const& b = world.bsdfs[k];
        bool const mirror = b.model == MaterialModel::metal_rough && b.f90.x > 0 &&
                            (b.alpha < kSmoothAlpha || m.metallic_roughness_map.texture >= 0);
        if (mirror || b.clear > 0 || (m.transmission_map.texture >= 0 && m.transmission > 0)) return true;
    }
    return false;
}

} // namespace gi
