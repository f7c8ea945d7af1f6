#include "gi/methods/paths/choose.h"

namespace gi {
namespace {

using P = PathsSettings;

template <class T>
RenderOption paths(char const* name, OptionValues values, char const* meaning, T P::*member)
{
    return {
        make_option<RenderSettings>(
            name, std::move(values), meaning, [member](auto& s) -> auto& { return s.template of<P>().*member; }),
        "Paths",
        {"auto", "paths", "paths_shadow_maps", "slhb", "slhb_shadow_rays", "screen_lhb", "paths_layered_lens",
         "slhb_0_1"}};
}

RenderOptionTable make_table()
{
    RenderOption cache =
        paths("radiance-cache", {"auto", "on", "off"},
              "paths may end in cached cells of radiance from earlier paths: far less noise in the same time, but\n"
              "slightly blurred indirect light; auto: on with --budget, and in viewers while something moves",
              &P::cache);
    cache.restarts = false;
    RenderOption interleave =
        paths("interleave", {0, 16},
              "compute indirect light for one pixel in each n x n block per pass (default: by the budget)",
              &P::interleave);
    interleave.live = false;
    return {
        std::move(cache),
        std::move(interleave),
        paths("roulette", {-1, 1000},
              "Russian roulette: paths continue with a probability of this times their throughput; 0: all paths\n"
              "continue up to the fourth scattering (default, or -1: 2 with --until, --frames, or a --budget for\n"
              "more than one path; 3 if paths end in a cache; else 0)",
              &P::roulette),
    };
}

} // namespace

RenderOptionTable const& paths_options()
{
    static RenderOptionTable const all = make_table();
    return all;
}

} // namespace gi
