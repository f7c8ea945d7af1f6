#include "gi/methods/slhb/directions/directions.h"
#include "gi/methods/slhb/settings.h"

namespace gi {
namespace {

using S = SlhbSettings;

template <class T>
RenderOption slhb(char const* names, OptionValues values, char const* meaning, T S::*member,
                  std::vector<UnusedBy> unused_by = {}, std::vector<std::string_view> methods = {"slhb"})
{
    return {make_option<RenderSettings>(
                names, std::move(values), meaning, [member](auto& s) -> auto& { return s.slhb.*member; }),
            "Method slhb", std::move(methods), std::move(unused_by)};
}

RenderOptionTable make_table()
{
    using enum Schedule;
    constexpr char const* kAllDirections = "axes are drawn from all directions";
    RenderOption directions = slhb("directions", {"", "icosahedron:80", "icosahedron:320", "icosahedron:1280"},
                                   "stored directions, FAMILY:COUNT (default icosahedron:320)", &S::directions,
                                   {{streamed, kAllDirections}, {temporal, kAllDirections}},
                                   {"slhb", "vpl_slhb", "sh_grid", "ispm", "lpv", "isllpm"});
    directions.takes_other_words = true;
    directions.set = [](RenderSettings& s, std::string const& text, std::string const&) {
        if (!text.empty()) make_directions(text); // throws
        s.slhb.directions = text;
    };
    RenderOption interleave =
        slhb("interleave", {0, 16},
             "compute indirect light for one pixel in each n x n block per pass (default: by the budget)",
             &S::interleave);
    interleave.live = false;
    return {
        slhb("schedule", {"auto", "stored", "streamed", "temporal"},
             "stored: one set of axes; streamed: new axes in every pass; temporal: some new; auto: streamed,\n"
             "but stored under a sky; in moving scenes stored with --reuse, streamed with --shutter",
             &S::schedule),
        slhb("look-ups", {"auto", "all", "none"},
             "all: paths find surfaces by look-ups in hit buffers; none: by exact rays; auto: by the plan",
             &S::look_ups),
        slhb("shadows", {"auto", "maps", "rays"},
             "maps: shadow maps of --light-samples samples, shared by all paths of a pass;\n"
             "rays: exact rays to light samples of each path; auto: by the plan",
             &S::shadows),
        slhb("radiance-cache", {"auto", "on", "off"},
             "paths may end in cached cells of radiance from earlier paths: far less noise in the same time, but\n"
             "slightly blurred indirect light; auto: on with --budget, and in viewers while something moves",
             &S::cache),
        directions,
        slhb("hit-buffer", {0, 8192}, "size of a hit buffer, texels on a side (default: by the plan)",
             &S::resolution, {}, {"slhb", "vpl_slhb", "sh_grid", "ispm", "lpv", "isllpm"}),
        slhb("axes", {0, 64}, "axes per bounce in a pass (default: by the plan); schedules streamed and temporal",
             &S::axes, {{stored, "all axes of --directions are used"}}),
        slhb("fresh-axes", {0, 64}, "axes replaced per pass (default: an eighth of them); schedule temporal",
             &S::fresh_axes, {{stored, "its axes do not change"}, {streamed, "all axes of a pass are new"}}),
        slhb("light-samples,lamps", {0, 1024},
             "number of light samples given a shadow map per pass (default: by the plan)", &S::light_samples),
        slhb("fresh-light-samples,fresh-lamps", {0, 1024},
             "light samples replaced per pass (default: all; few in consecutive frames)", &S::fresh_light_samples),
        slhb("shadow-map", {0, 8192}, "size of a shadow map, texels on a side (default: by the plan)",
             &S::shadow_resolution),
        interleave,
        slhb("memory", {0, 1 << 24},
             "MiB for hit buffers, and as much for shadow maps; they get fewer texels if it is not enough\n"
             "(default: a quarter of the machine's memory)",
             &S::memory_mib),
        slhb("max-layers", {0, 1 << 20}, "most layers per texel, others counted; 0 = all", &S::most_layers, {},
             {"slhb", "vpl_slhb"}),
        slhb("roulette", {-1, 1000},
             "Russian roulette: paths continue with a probability of this times their throughput; 0: all paths\n"
             "continue up to the fourth scattering (default, or -1: 2 with --until, --frames, or a --budget for\n"
             "more than one path; 3 if paths end in a cache; else 0)",
             &S::roulette),
        slhb("cone", {0, 64}, "radius of the cone approximation, texels", &S::cone),
        slhb("packed", {}, "use layers of 32 bits instead of 64, for up to 524288 triangles", &S::packed),
        slhb("gather", {}, "first bounce along all axes in turn instead of at random", &S::gather),
    };
}

} // namespace

RenderOptionTable const& slhb_options()
{
    static RenderOptionTable const all = make_table();
    return all;
}

} // namespace gi
