#include "gi/methods/registry.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/light_paths/options.h"
#include "gi/methods/photons/explain.h"
#include "gi/methods/photons/methods.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/sh_grid/explain.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "gi/methods/slhb/frames.h"
#include "gi/methods/slhb/settings.h"
#include "gi/methods/slhb/slhb.h"
#include "gi/methods/vpl/visibility.h"
#include "gi/methods/whitted/whitted.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>

namespace gi {
namespace {

template <VisibilityKind kind>
constexpr Method virtual_lights(std::string_view name, std::string_view summary)
{
    return {name, summary, render_visibility<kind>, start_visibility_frames<kind>, virtual_light_options};
}

constexpr std::array kMethods{
    Method{"reference", "path tracing with exact rays: slow, unbiased, for comparison", render_reference,
           start_reference_frames},
    Method{"slhb", "path tracing through spherical layered hit buffers: look-ups instead of rays", render_slhb,
           start_slhb_frames, slhb_options, explain_settings},
    Method{"whitted", "ray trees: direct light, mirrors and glass, no diffuse interreflection", render_whitted,
           start_whitted_frames, whitted_options},
    Method{"sh_grid", "ray trees, with indirect light from photons in a field of spherical harmonics",
           render_sh_grid, start_sh_grid_frames, sh_grid_options, explain_sh_grid},
    Method{"ispm", "ray trees, with indirect light from photons splatted in image space", render_ispm,
           start_ispm_frames, nullptr, explain_ispm},
    Method{"lpv", "ray trees, with indirect light that propagates through a lattice", render_lpv, start_lpv_frames,
           nullptr, explain_lpv},
    Method{"isllpm", "ray trees, with indirect light from photons in lattices", render_isllpm, start_isllpm_frames,
           nullptr, explain_isllpm},
    Method{"multi_image", "ray trees, with indirect light from photons that follow distance impostors",
           render_multi_image, start_multi_image_frames, nullptr, explain_multi_image},
    virtual_lights<VisibilityKind::exact>(
        "vpl_exact", "virtual point lights for indirect light, visibility by exact rays; the other vpl_*\n"
                     "    methods differ only in how they find visibility"),
    virtual_lights<VisibilityKind::slhb>("vpl_slhb", "... by look-ups in spherical layered hit buffers"),
    virtual_lights<VisibilityKind::imperfect>("vpl_imperfect", "... by imperfect shadow maps, drawn from points"),
    virtual_lights<VisibilityKind::ambient>("vpl_ao", "... by ambient occlusion within a radius"),
    virtual_lights<VisibilityKind::directional>("vpl_dao", "... by directional occlusion within a radius"),
    virtual_lights<VisibilityKind::none>("vpl_none", "... none: every surface sees every other"),
};

/// Why a method that reads the option with some schedule does not with its own; nullptr if it does.
char const* why_unused(RenderOption const& option, ChosenMethod const& method)
{
    for (UnusedBy const& u : option.unused_by)
        if (u.schedule == method.schedule && render_option("schedule").read_by(method.name)) return u.why;
    return nullptr;
}

void check_used(RenderOption const& option, std::vector<ChosenMethod> const& methods)
{
    ChosenMethod const* reader = nullptr;
    for (ChosenMethod const& m : methods) {
        if (!option.read_by(m.name)) continue;
        if (why_unused(option, m) == nullptr) return;
        if (reader == nullptr) reader = &m;
    }
    if (reader == nullptr)
        throw InputError(fmt::format("--{} with --method {}", option.name, methods.front().name),
                         fmt::format("it applies to {}", fmt::join(option.methods, " and ")),
                         "add such a method, or leave it out");
    throw InputError(fmt::format("--{} with {}", option.name, reader->as_given), why_unused(option, *reader),
                     "leave one of them out");
}

} // namespace

std::span<Method const> methods() { return kMethods; }

std::vector<std::string> method_names()
{
    std::vector<std::string> names;
    for (Method const& m : kMethods) names.emplace_back(m.name);
    return names;
}

Method const& find_method(std::string_view name)
{
    for (Method const& m : kMethods)
        if (m.name == name) return m;
    throw InputError("there is no method '" + std::string(name) + "'", "it is not in the registry",
                     suggest(std::string(name), method_names()));
}

RenderOptionTable const& render_options()
{
    static RenderOptionTable const all = [] {
        RenderOptionTable table = common_options();
        table.insert(table.end(), photon_options().begin(), photon_options().end());
        std::vector<RenderOptionTable const*> added;
        for (Method const& m : methods()) {
            if (m.options == nullptr || std::ranges::find(added, &m.options()) != added.end()) continue;
            added.push_back(&m.options());
            table.insert(table.end(), m.options().begin(), m.options().end());
        }
        return table;
    }();
    return all;
}

RenderOption const* find_render_option(std::string_view name)
{
    for (RenderOption const& o : render_options())
        if (o.is_called(name)) return &o;
    return nullptr;
}

RenderOption const& render_option(std::string_view name) { return *find_render_option(name); }

void check_options(std::vector<std::string> const& given, RenderSettings const& settings,
                   std::vector<ChosenMethod> const& methods)
{
    auto const is_given = [&](char const* name) { return std::ranges::find(given, name) != given.end(); };
    for (std::string const& name : given) check_used(render_option(name), methods);
    bool const any_schedule = std::ranges::none_of(
        methods, [](ChosenMethod const& m) { return m.name == "slhb" && m.schedule != Schedule::automatic; });
    if (any_schedule && is_given("directions") && (is_given("axes") || is_given("fresh-axes")))
        throw InputError("--directions with --axes or --fresh-axes",
                         "only the stored schedule uses --directions, only the others draw axes",
                         "leave one of them out");
    SlhbSettings const& s = settings.slhb;
    auto const check_part = [](char const* part, int fresh, char const* whole, int all) {
        if (all > 0 && fresh > all)
            throw InputError(fmt::format("{} is larger than {}", part, whole), "it is the part that is new",
                             fmt::format("give at most {}", all));
    };
    check_part("--fresh-axes", s.fresh_axes, "--axes", s.axes);
    check_part("--fresh-light-samples", s.fresh_light_samples, "--light-samples", s.light_samples);
}

} // namespace gi
