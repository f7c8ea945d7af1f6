#include "gi/methods/sh_grid/settings.h"
#include "gi/methods/sh_grid/sh_grid.h"

namespace gi {
namespace {

template <class T>
RenderOption field(char const* name, OptionValues values, char const* meaning, T ShGridSettings::*member)
{
    return {make_option<RenderSettings>(
                name, std::move(values), meaning, [member](auto& s) -> auto& { return s.template of<ShGridSettings>().*member; }),
            "Method sh_grid",
            {"sh_grid"}};
}

} // namespace

RenderOptionTable const& sh_grid_options()
{
    using S = ShGridSettings;
    static RenderOptionTable const all{
        field("voxels", {8, S::kMostVoxels},
              "voxels along the scene's longest side, the field has a quarter of them; with a --budget fewer, if\n"
              "they would take more than half of it",
              &S::voxels),
        field("field-degree", {1, 4}, "of the spherical harmonics", &S::degree),
        field("field-directions", {16, 65536}, "directions per cell of the field", &S::directions),
        field("gather-directions", {0, 4096}, "samples of the diffuse lobe; 0 = convolution in closed form",
              &S::gather_directions),
        field("glossy-directions", {1, 4096}, "samples of glossy lobes", &S::glossy_directions),
        field("obscurance-radius", {0, 1e9}, "m; surfaces nearer than this darken diffuse light, 0 = off",
              &S::obscurance_m),
        field("field-shadow-rays", {0, 27},
              "rays from a surface to cells of the field, so that light does not leak through walls; 0 = none",
              &S::field_shadow_rays),
        field("field-passes", {1, 64}, "passes (frames) over which the field follows a change of the scene",
              &S::field_passes),
        field("field-rays", {"exact", "voxels"},
              "rays from the field's cells: exact ones, or through the grid of voxels", &S::field_rays),
        field("radiance-by", {"normal", "direction"},
              "divide the light of a cell by the normals of its surfaces, or by the directions of photons",
              &S::radiance_by),
        field("multilevel", {"on", "off"}, "read coarser grids of radiance where directions are sparse",
              &S::multilevel),
        field("leak-weights", {"on", "off"},
              "weigh cells of the field by what may lie between them and the surface", &S::leak_weights),
        field("field-glyphs", {"on", "off"},
              "draw a sphere in each cell of the field, which shows what arrives there by direction",
              &S::field_glyphs)};
    return all;
}

} // namespace gi
