#include "gi/methods/registry.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/hit_buffers/options.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/light_paths/options.h"
#include "gi/methods/automatic/automatic.h"
#include "gi/methods/paths/paths.h"
#include "gi/methods/photons/explain.h"
#include "gi/methods/photons/methods.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/sh_grid/explain.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "gi/methods/slhb/slhb.h"
#include "gi/methods/slhb_0_1/slhb_0_1.h"
#include "gi/methods/vpl/visibility.h"
#include "gi/methods/whitted/whitted.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>

namespace gi {
namespace {

/// Of a method that builds nothing by the scene.
std::vector<PlanItem> explain_light(World const& world, RenderSettings const& asked, Camera const&)
{
    return {explain_lamp_caustics(world, asked)};
}

/// @param visibility, variant  see Method
template <VisibilityKind kind>
constexpr Method virtual_lights(std::string_view name, std::string_view visibility, std::string_view summary,
                                std::string_view variant = {})
{
    return {.name = name,
            .summary = summary,
            .render = render_visibility<kind>,
            .frames = start_visibility_frames<kind>,
            .options = virtual_light_options,
            .explain = explain_light,
            .variant = variant,
            .visibility = visibility};
}

template <PathAlgorithm by>
std::vector<PlanItem> explain_paths(World const& world, RenderSettings const& asked, Camera const& camera)
{
    return explain_choices(world, with(by, asked), camera);
}

/// @tparam M  see Mixed
template <class M>
constexpr Method mixed(std::string_view summary)
{
    return {.name = M::kName,
            .summary = summary,
            .render = M::render,
            .frames = M::frames,
            .options = hit_buffer_options,
            .explain = explain_paths<M::kBy>,
            .ends_frames_early = true,
            .pairs = true,
            .variant = M::kLooksUp ? "schedule" : "",
            .for_display = M::kLooksUp ? slhb_for_display : paths_for_display,
            .for_exposure = M::exposure,
            .updates_axes = M::kLooksUp ? slhb_updates_axes : nullptr,
            .check = check_hit_buffer_options};
}

constexpr std::array kMethods{
    Method{.name = "auto",
           .summary = "the plan chooses by costs: paths, look-ups where a BVH takes too long; on CUDA reference;\n"
                      "    lightwell info says which and why",
           .render = render_auto,
           .frames = start_auto_frames,
           .explain = explain_auto,
           .ends_frames_early = true,
           .pairs = true,
           .choose = choose_method,
           .for_display = paths_for_display,
           .for_exposure = auto_exposure,
           .check = check_auto_options},
    Method{.name = "paths",
           .summary = "path tracing with exact rays, light samples chosen by resampling, and a radiance cache",
           .render = render_paths,
           .frames = start_path_frames,
           .options = paths_options,
           .explain = explain_paths<PathAlgorithm{}>,
           .ends_frames_early = true,
           .pairs = true,
           .for_display = paths_for_display,
           .for_exposure = paths_exposure},
    Method{.name = "slhb",
           .summary = "path tracing by look-ups in spherical layered hit buffers and shadow maps, exact rays "
                      "where they are doubtful",
           .render = render_slhb,
           .frames = start_slhb_frames,
           .options = hit_buffer_options,
           .explain = explain_paths<kSlhb>,
           .ends_frames_early = true,
           .pairs = true,
           .variant = "schedule",
           .for_display = slhb_for_display,
           .for_exposure = slhb_exposure,
           .updates_axes = slhb_updates_axes,
           .check = check_hit_buffer_options},
    Method{"reference", "path tracing with exact rays, simple and unbiased: noisy, to compare others with",
           render_reference, start_reference_frames, nullptr, explain_light},
    mixed<PathsShadowMaps>("as paths, with the shadow maps of slhb"),
    mixed<SlhbShadowRays>("as slhb, with exact rays for shadows"),
    Method{.name = "screen_lhb",
           .summary =
               "as paths, but broad lobes meet only surfaces within the view, in one layered hit buffer of it",
           .render = render_screen_lhb,
           .frames = start_screen_lhb_frames,
           .options = hit_buffer_options,
           .explain = explain_paths<kScreenLhb>,
           .ends_frames_early = true,
           .pairs = true,
           .for_display = paths_for_display,
           .check = check_screen_lhb_options},
    Method{.name = "paths_layered_lens",
           .summary = "as paths, but depth of field and motion blur of the camera are gathered from layers of the "
                      "view, which are shaded once",
           .render = render_layered_lens,
           .frames = start_layered_lens_frames,
           .options = paths_options,
           .explain = explain_paths<kPathsLayeredLens>,
           .ends_frames_early = true,
           .pairs = true,
           .for_display = paths_for_display,
           .check = check_layered_lens_options},
    Method{"whitted", "ray trees: direct light, mirrors and glass, no diffuse interreflection", render_whitted,
           start_whitted_frames, whitted_options, explain_light},
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
        "vpl_exact", "exact",
        "virtual point lights for indirect light, visibility by exact rays; the other vpl_*\n"
        "    methods differ only in how they find visibility"),
    virtual_lights<VisibilityKind::slhb>("vpl_slhb", "slhb", "... by look-ups in spherical layered hit buffers",
                                         "directions"),
    virtual_lights<VisibilityKind::imperfect>("vpl_imperfect", "imperfect",
                                              "... by imperfect shadow maps, drawn from points", "points"),
    virtual_lights<VisibilityKind::ambient>("vpl_ao", "ao", "... by ambient occlusion within a radius",
                                            "ao-radius"),
    virtual_lights<VisibilityKind::directional>("vpl_dao", "directional_ao",
                                                "... by directional occlusion within a radius", "ao-radius"),
    virtual_lights<VisibilityKind::none>("vpl_none", "none", "... none: every surface sees every other"),
    Method{.name = "slhb_0_1",
           .summary = "what version 0.1 called slhb: rays or look-ups, by its options",
           .render = render_slhb_0_1,
           .frames = start_slhb_0_1_frames,
           .options = slhb_0_1_options,
           .offered = false,
           .ends_frames_early = true,
           .pairs = true,
           .variant = "schedule",
           .for_display = slhb_0_1_for_display,
           .for_exposure = slhb_0_1_exposure,
           .updates_axes = slhb_updates_axes,
           .check = check_hit_buffer_options},
};

std::optional<Unused> why_unused(RenderOption const& option, ChosenMethod const& method)
{
    return option.unused && render_option("schedule").read_by(method.name) ? option.unused(method.settings)
                                                                            : std::nullopt;
}

void check_used(RenderOption const& option, std::vector<ChosenMethod> const& methods)
{
    ChosenMethod const* reader = nullptr;
    for (ChosenMethod const& m : methods) {
        if (!option.read_by(m.name)) continue;
        if (!why_unused(option, m)) return;
        if (reader == nullptr) reader = &m;
    }
    if (reader == nullptr && !option.replaced_by.empty())
        throw InputError(fmt::format("--{} with --method {}", option.name, methods.front().name),
                         "its values are methods of their own now", "give " + option.replaced_by);
    if (reader == nullptr) {
        std::vector<std::string_view> readers;
        for (std::string_view const name : option.methods)
            if (name.ends_with('*') || find_method(name).offered) readers.push_back(name);
        throw InputError(fmt::format("--{} with --method {}", option.name, methods.front().name),
                         fmt::format("it applies to {}", fmt::join(readers, ", ")),
                         "add such a method, or leave it out");
    }
    Unused const unused = *why_unused(option, *reader);
    throw InputError(fmt::format("--{} with {}", option.name, reader->as_given.empty() ? unused.by : reader->as_given),
                     unused.why, "leave one of them out");
}

} // namespace

std::span<Method const> methods() { return kMethods; }

std::vector<std::string> method_names()
{
    std::vector<std::string> names;
    for (Method const& m : kMethods)
        if (m.offered) names.emplace_back(m.name);
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

std::string options_of(std::string_view method, RenderSettings const& settings)
{
    std::vector<std::string_view> names;
    for (RenderOption const& o : render_options())
        if (!o.methods.empty() && o.name != "device" && o.read_by(method)) names.push_back(o.name);
    return as_options(render_options(), settings, names);
}

void check_options(std::vector<std::string> const& given, std::vector<ChosenMethod> const& methods)
{
    for (std::string const& name : given) check_used(render_option(name), methods);
    for (ChosenMethod const& m : methods)
        if (auto const check = find_method(m.name).check) check(given, m.settings);
}

} // namespace gi
