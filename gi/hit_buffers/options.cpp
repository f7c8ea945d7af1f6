#include "gi/hit_buffers/options.h"

#include "gi/core/error.h"
#include "gi/hit_buffers/directions/directions.h"
#include "gi/hit_buffers/windows.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

using S = SlhbSettings;

using Methods = std::vector<std::string_view>;

/// Methods that read options of both look-ups and shadow maps, of look-ups alone,
/// of shadow maps alone, and of stored axes alone; slhb_0_1 has no levels and no exact rays for doubts.
Methods const kBoth{"slhb", "slhb_shadow_rays", "paths_shadow_maps", "slhb_0_1"},
    kLevels{"slhb", "slhb_shadow_rays", "paths_shadow_maps"}, kLookUps{"slhb", "slhb_shadow_rays", "slhb_0_1"},
    kMaps{"slhb", "paths_shadow_maps", "slhb_0_1"};
Methods with_stored_axes_too(Methods more)
{
    more.insert(more.begin(), kLookUps.begin(), kLookUps.end());
    return more;
}

template <class T>
RenderOption option(char const* names, OptionValues values, char const* meaning, T S::*member, Methods methods,
                    char const* group = "Hit buffers")
{
    return {make_option<RenderSettings>(
                names, std::move(values), meaning, [member](auto& s) -> auto& { return s.template of<S>().*member; }),
            group, std::move(methods)};
}

/// Why a schedule leaves an option unused; nullptr for those that use it.
RenderOption unless(RenderOption option, std::vector<std::pair<Schedule, char const*>> why)
{
    option.unused = [why = std::move(why)](RenderSettings const& s) -> std::optional<Unused> {
        for (auto const& [schedule, reason] : why)
            if (s.of<S>().schedule == schedule)
                return Unused{as_options(hit_buffer_options(), s, {"schedule"}), reason};
        return std::nullopt;
    };
    return option;
}

RenderOptionTable make_table()
{
    using enum Schedule;
    constexpr char const* kAllDirections = "axes are drawn from all directions";
    constexpr char const* kMapGroup = "Shadow maps";
    RenderOption directions =
        unless(option("directions", {"", "icosahedron:80", "icosahedron:320", "icosahedron:1280"},
                      "stored directions, FAMILY:COUNT (default icosahedron:320)", &S::directions,
                      with_stored_axes_too({"vpl_slhb", "sh_grid", "ispm", "lpv", "isllpm"})),
               {{streamed, kAllDirections}, {temporal, kAllDirections}});
    directions.takes_other_words = true;
    directions.set = [](RenderSettings& s, std::string const& text, std::string const&) {
        if (!text.empty()) make_directions(text); // throws
        s.of<SlhbSettings>().directions = text;
    };
    return {
        option("schedule", {"auto", "stored", "streamed", "temporal"},
               "stored: one set of axes; streamed: new axes in every pass; temporal: some new; auto: streamed,\n"
               "but stored under a sky; in moving scenes stored with --reuse, streamed with --shutter",
               &S::schedule, kLookUps),
        std::move(directions),
        option("hit-buffer", {0, 8192}, "size of a hit buffer, texels on a side (default: by the plan)",
               &S::resolution,
               with_stored_axes_too({"screen_lhb", "vpl_slhb", "sh_grid", "ispm", "lpv", "isllpm"})),
        unless(option("axes", {0, 64},
                      "axes per bounce in a pass (default: by the plan); schedules streamed and temporal",
                      &S::axes, kLookUps),
               {{stored, "all axes of --directions are used"}}),
        unless(option("fresh-axes", {0, 64},
                      "axes replaced per pass (default: an eighth of them); schedule temporal", &S::fresh_axes,
                      kLookUps),
               {{stored, "its axes do not change"}, {streamed, "all axes of a pass are new"}}),
        option("max-layers", {0, 1 << 20}, "most layers per texel, others counted; 0 = all", &S::most_layers,
               with_stored_axes_too({"vpl_slhb"})),
        option("cone", {0, 64}, "radius of the cone approximation, texels", &S::cone, kLookUps),
        option("packed", {}, "use layers of 32 bits instead of 64, for up to 524288 triangles", &S::packed,
               kLookUps),
        option("gather", {}, "first bounce along all axes in turn instead of at random", &S::gather, kLookUps),
        option("levels", {0, int(kMostLevels)},
               "most nested grids of hit buffers and shadow maps, each with finer texels nearer to the cameras, "
               "each\n"
               "as costly as the first; 1: one for the whole world; default: as the world's size needs, 2 with a\n"
               "--budget, 1 with --packed and orthographic cameras",
               &S::levels, kLevels),
        option("confirm", {"auto", "on", "off"},
               "where the four texels around a look-up, or around a test by a shadow map, disagree, an exact ray\n"
               "decides; auto: on, unless the rays' tree would take more than a fifth of the --budget of a "
               "picture, or with --cone",
               &S::confirm, kLevels),
        option("memory", {0, 1 << 24},
               "MiB for hit buffers, and as much for shadow maps; they get fewer texels if it is not enough\n"
               "(default: a quarter of the machine's memory)",
               &S::memory_mib, kBoth),
        option("light-samples,lamps", {0, 1024},
               "number of light samples given a shadow map per pass (default: by the plan)", &S::light_samples,
               kMaps, kMapGroup),
        option("fresh-light-samples,fresh-lamps", {0, 1024},
               "light samples replaced per pass (default: all; few in consecutive frames)",
               &S::fresh_light_samples, kMaps, kMapGroup),
        option("shadow-map", {0, 8192}, "size of a shadow map, texels on a side (default: by the plan)",
               &S::shadow_resolution, kMaps, kMapGroup),
    };
}

} // namespace

RenderOptionTable const& hit_buffer_options()
{
    static RenderOptionTable const all = make_table();
    return all;
}

void check_hit_buffer_options(std::vector<std::string> const& given, RenderSettings const& settings)
{
    S const& s = settings.of<S>();
    auto const is_given = [&](char const* name) { return std::ranges::find(given, name) != given.end(); };
    if (s.schedule == Schedule::automatic && is_given("directions") && (is_given("axes") || is_given("fresh-axes")))
        throw InputError("--directions with --axes or --fresh-axes",
                         "only the stored schedule uses --directions, only the others draw axes",
                         "leave one of them out");
    if (s.packed && s.levels > 1)
        throw InputError("--packed with --levels",
                         "depths of 12 bits have too few steps for a world that needs levels",
                         "leave one of them out");
    auto const check_part = [](char const* part, int fresh, char const* whole, int all) {
        if (all > 0 && fresh > all)
            throw InputError(fmt::format("{} is larger than {}", part, whole), "it says how many of them are new",
                             fmt::format("give at most {}", all));
    };
    check_part("--fresh-axes", s.fresh_axes, "--axes", s.axes);
    check_part("--fresh-light-samples", s.fresh_light_samples, "--light-samples", s.light_samples);
}

} // namespace gi
