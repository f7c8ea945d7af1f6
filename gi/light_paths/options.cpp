#include "gi/light_paths/options.h"

namespace gi {
namespace {

using P = PhotonSettings;
using Methods = std::vector<std::string_view>;

template <class T>
RenderOption photons(char const* name, OptionValues values, char const* meaning, T P::*member, Methods methods)
{
    return {make_option<RenderSettings>(
                name, std::move(values), meaning, [member](auto& s) -> auto& { return s.photons.*member; }),
            "Photons", std::move(methods)};
}

} // namespace

RenderOptionTable const& photon_options()
{
    Methods const maps{"ispm", "lpv", "isllpm", "multi_image"},
        all{"sh_grid", "ispm", "lpv", "isllpm", "multi_image"},
        caustics{"sh_grid", "ispm", "isllpm", "multi_image"};
    static RenderOptionTable const table{
        photons("photons", {1, P::kMostPaths},
                "light paths per set of photons; with a --budget fewer, if they would take more than half of it",
                &P::paths, all),
        photons("caustic-photons", {0, P::kMostPaths},
                "light paths per pass that begin on mirrors and glass, fewer as --photons are; 0 = no caustics",
                &P::caustic_paths, caustics),
        photons("caustic-radius", {0, 1e9}, "m; of the first kernels of caustics, 0 = by their density",
                &P::caustic_radius_m, caustics),
        photons("reflections", {1, 64}, "of a photon, at most", &P::reflections, all),
        photons(
            "photon-rays", {"exact", "look-ups", "impostors"},
            "what finds the surfaces that photons meet: exact rays, look-ups in hit buffers, distance impostors",
            &P::rays, {"ispm", "lpv", "isllpm"}),
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
    };
    return table;
}

} // namespace gi
