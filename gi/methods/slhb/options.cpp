#include "gi/methods/slhb/options.h"

#include "gi/methods/slhb/directions/directions.h"

namespace gi {
namespace {

template <class T>
RenderOption slhb(OptionFacts facts, T SlhbSettings::*member, OptionUse use = {})
{
    if (use.methods.empty()) use.methods = {"slhb"};
    return {make_option<RenderSettings>(
                std::move(facts), [member](auto& s) -> auto& { return s.slhb.*member; }),
            "Method slhb", std::move(use)};
}

RenderOption directions()
{
    RenderOption o = slhb(word_option("directions", {"", "icosahedron:80", "icosahedron:320", "icosahedron:1280"},
                                      "stored directions, FAMILY:COUNT (default icosahedron:320)"),
                          &SlhbSettings::directions,
                          {.methods = {"slhb", "vpl_slhb"},
                           .unused_by = {{Schedule::streamed, "axes are drawn from all directions"},
                                         {Schedule::temporal, "axes are drawn from all directions"}}});
    o.takes_other_words = true;
    o.set = [](RenderSettings& s, std::string const& text, std::string const&) {
        if (!text.empty()) make_directions(text); // throws
        s.slhb.directions = text;
    };
    return o;
}

RenderOptionTable make_table()
{
    using S = SlhbSettings;
    OptionUse const also_of_vpl{.methods = {"slhb", "vpl_slhb"}, .unused_by = {}};
    OptionUse const of_axes{.methods = {}, .unused_by = {{Schedule::stored, "all axes of --directions are used"}}};
    OptionUse const of_fresh_axes{.methods = {},
                                  .unused_by = {{Schedule::stored, "its axes do not change"},
                                                {Schedule::streamed, "all axes of a pass are new"}}};
    OptionUse const of_pictures{.methods = {}, .unused_by = {}, .live = false};
    return {
        slhb(word_option(
                 "device", {"cpu", "cuda"},
                 "cpu; or cuda: all by CUDA kernels, also with --reuse or --shutter; paths end at mirrors,\n"
                 "glass and narrow lobes, which is counted"),
             &S::space),
        slhb(word_option(
                 "schedule", {"auto", "stored", "streamed", "temporal"},
                 "stored: one set of axes; streamed: new axes in every pass; temporal: some new; auto: streamed,\n"
                 "but stored under a sky; in moving scenes stored with --reuse, streamed with --shutter"),
             &S::schedule),
        slhb(word_option(
                 "look-ups", {"auto", "all", "none"},
                 "all: paths find surfaces by look-ups in hit buffers; none: by exact rays; auto: by the plan"),
             &S::look_ups),
        slhb(word_option("shadows", {"auto", "maps", "rays"},
                         "maps: shadow maps of --light-samples samples, shared by all paths of a pass;\n"
                         "rays: exact rays to light samples of each path; auto: by the plan"),
             &S::shadows),
        slhb(word_option(
                 "radiance-cache", {"auto", "on", "off"},
                 "paths may end in cached cells of radiance from earlier paths: far less noise in the same time, "
                 "but\n"
                 "slightly blurred indirect light; auto: on with --budget, and in viewers while something moves"),
             &S::cache),
        directions(),
        slhb(whole_option("hit-buffer", 0, 8192, "size of a hit buffer, texels on a side (default: by the plan)"),
             &S::resolution, also_of_vpl),
        slhb(whole_option("axes", 0, 64,
                          "axes per bounce in a pass (default: by the plan); schedules streamed and temporal"),
             &S::axes, of_axes),
        slhb(whole_option("fresh-axes", 0, 64,
                          "axes replaced per pass (default: an eighth of them); schedule temporal"),
             &S::fresh_axes, of_fresh_axes),
        slhb(whole_option("light-samples,lamps", 0, 1024,
                          "number of light samples given a shadow map per pass (default: by the plan)"),
             &S::light_samples),
        slhb(whole_option("fresh-light-samples,fresh-lamps", 0, 1024,
                          "light samples replaced per pass (default: all; few in consecutive frames)"),
             &S::fresh_light_samples),
        slhb(whole_option("shadow-map", 0, 8192, "size of a shadow map, texels on a side (default: by the plan)"),
             &S::shadow_resolution),
        slhb(whole_option(
                 "interleave", 0, 16,
                 "compute indirect light for one pixel in each n x n block per pass (default: by the budget)"),
             &S::interleave, of_pictures),
        slhb(whole_option("memory", 0, 1 << 24,
                          "MiB for hit buffers, and as much for shadow maps; they get fewer texels if it is not "
                          "enough\n(default: a quarter of the machine's memory)"),
             &S::memory_mib),
        slhb(whole_option("max-layers", 0, 1 << 20, "most layers per texel, others counted; 0 = all"),
             &S::most_layers, also_of_vpl),
        slhb(number_option("roulette", -1, 1000,
                           "Russian roulette: paths continue with a probability of this times their throughput; "
                           "0: all paths\n"
                           "continue up to the fourth scattering (default, or -1: 2 with --until, --frames, or a "
                           "--budget for\n"
                           "more than one path; 3 if paths end in a cache; else 0)"),
             &S::roulette),
        slhb(number_option("cone", 0, 64, "radius of the cone approximation, texels"), &S::cone),
        slhb(flag_option("packed", "use layers of 32 bits instead of 64, for up to 524288 triangles"), &S::packed),
        slhb(flag_option("gather", "first bounce along all axes in turn instead of at random"), &S::gather),
    };
}

} // namespace

RenderOptionTable const& slhb_options()
{
    static RenderOptionTable const all = make_table();
    return all;
}

} // namespace gi
