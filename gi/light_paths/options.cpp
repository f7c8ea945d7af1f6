#include "gi/light_paths/options.h"

#include "gi/light_paths/impostor_places.h"

namespace gi {
namespace {

using P = PhotonSettings;
using Methods = std::vector<std::string_view>;

template <class T>
RenderOption photons(char const* name, OptionValues values, char const* meaning, T P::*member, Methods methods)
{
    return {make_option<RenderSettings>(
                name, std::move(values), meaning, [member](auto& s) -> auto& { return s.template of<PhotonSettings>().*member; }),
            "Photons", std::move(methods)};
}

} // namespace

RenderOptionTable const& photon_options()
{
    Methods const maps{"ispm", "lpv", "isllpm", "multi_image"},
        all{"sh_grid", "ispm", "lpv", "isllpm", "multi_image"},
        caustics{"sh_grid",
                 "ispm",
                 "isllpm",
                 "multi_image",
                 "reference",
                 "auto",
                 "paths",
                 "slhb",
                 "paths_shadow_maps",
                 "slhb_shadow_rays",
                 "screen_lhb",
                 "paths_layered_lens",
                 "slhb_0_1"};
    RenderOption places = photons(
        "impostor-places", {"", "0,1.5,0", "0,1.5,0;4,1.5,0"},
        "centres of the distance impostors, x,y,z;x,y,z in m in the scene's coordinates (default: automatic)",
        &P::impostor_places, {"ispm", "lpv", "isllpm", "multi_image"});
    places.takes_other_words = true;
    places.set = [](RenderSettings& s, std::string const& text, std::string const&) {
        if (!text.empty()) read_impostor_places(text); // throws
        s.of<PhotonSettings>().impostor_places = text;
    };
    static RenderOptionTable const table{
        places,
        photons("photons", {1, P::kMostPaths},
                "light paths per set of photons; with a --budget as many as fit a part of it", &P::paths, all),
        photons("caustic-photons", {0, P::kMostPaths},
                "light paths per pass that begin on mirrors and glass, fewer as --photons are; 0 = no caustics;\n"
                "    paths, slhb and reference: in pictures, of lamps without extent, at most one for 4 pixels",
                &P::caustic_paths, caustics),
        photons("caustic-radius", {0, 1e9}, "m; of the first kernels of caustics, 0 = by their density",
                &P::caustic_radius_m, caustics),
        photons("reflections", {1, 64}, "of a photon, at most", &P::reflections, all),
        photons(
            "photon-rays", {"exact", "look-ups", "impostors"},
            "what finds the surfaces that photons meet: exact rays, look-ups in hit buffers, distance impostors",
            &P::rays, {"sh_grid", "ispm", "lpv", "isllpm"}),
        photons("first-bounce", {"rays", "map"},
                "find the first surfaces of light paths by rays, or rasterise them as seen from the lights",
                &P::first_bounce, {"ispm", "lpv", "isllpm", "multi_image"}),
        photons("frozen-light", {"on", "off"},
                "compute light once and keep it while camera and scene move: many photons, no waiting", &P::frozen,
                maps),
        photons("kernel-by", {"density", "footprint"},
                "size kernels of photons by how many there are, or by the density of their path", &P::kernel_by,
                {"ispm"}),
        photons("kernel-size", {0.01, 100}, "factor of the radii of photons' kernels", &P::kernel_size, {"ispm"}),
        photons("propagation-cells", {8, 128}, "of each lattice in which light propagates, along the longest side",
                &P::propagation_cells, {"lpv"}),
        photons(
            "propagation-cascades", {0, 8},
            "nested lattices, each finer one half as wide, about the camera; 0 = about what it shows, as many\n"
            "as needed so that the finest just holds it",
            &P::propagation_cascades, {"lpv"}),
        photons("propagation-steps", {0, 1024}, "from cell to cell; 0 = twice the cells", &P::propagation_steps,
                {"lpv"}),
        photons("reprojection", {"beams", "cosine-lobes"},
                "light that passes a cell's face goes on as it came, or in a cosine about the face's normal",
                &P::reprojection, {"lpv"}),
        photons("low-cells", {4, 512}, "of the lattice of diffuse light of two and more reflections",
                &P::low_cells, {"isllpm"}),
        photons("middle-cells", {4, 512}, "of the lattice of diffuse light of one reflection", &P::middle_cells,
                {"isllpm"}),
        photons("high-cells", {4, 512}, "of the lattice of caustics", &P::high_cells, {"isllpm"}),
        photons(
            "lattice-cascades", {0, 8},
            "nested lattices, each finer one half as wide, about the camera; 0 = about what it shows, as many\n"
            "as needed so that the finest just holds it",
            &P::lattice_cascades, {"isllpm", "multi_image"}),
        photons("lattice-smoothing", {"on", "off"},
                "mean over 3 x 3 x 3 cells of the lattices of diffuse light: less noise, more blur",
                &P::lattice_smoothing, {"isllpm"}),
        photons("impostors", {1, 256}, "distance impostors that stand for the scene, at most", &P::impostors,
                {"sh_grid", "ispm", "lpv", "isllpm", "multi_image"}),
        photons("impostor-texels", {8, 2048},
                "along an edge of a face of a distance impostor, rounded up to a multiple of 8",
                &P::impostor_texels, {"sh_grid", "ispm", "lpv", "isllpm", "multi_image"}),
        photons("impostor-search", {"first-guess", "all", "cascaded", "walk"},
                "follow rays through distance impostors by iteration in the nearest one, in all, after a search\n"
                "through a fan of directions, or by a walk through their texels",
                &P::impostor_search, {"sh_grid", "ispm", "lpv", "isllpm", "multi_image"}),
        photons("volume-cells", {4, 512}, "of the light gathering volume, along the scene's longest side",
                &P::volume_cells, {"multi_image"}),
        photons("volume-gathers", {0, 64}, "steps that spread diffuse light over the six neighbours of a cell",
                &P::volume_gathers, {"multi_image"}),
        photons("screen-gathers", {0, 1000}, "steps that spread caustics over neighbouring pixels",
                &P::screen_gathers, {"multi_image"}),
        photons("caustics-by", {"lattice", "kernels"},
                "show caustics by the finest lattice, or by kernels of photons, without its cells",
                &P::caustics_by, {"isllpm"}),
        photons("irradiance-by", {"normals", "directions"},
                "divide the light of a cell by its surfaces' normals, or by their area in the photons' directions",
                &P::irradiance_by, {"isllpm"}),
    };
    return table;
}

} // namespace gi
