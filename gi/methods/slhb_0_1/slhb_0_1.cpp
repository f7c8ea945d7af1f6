#include "gi/methods/slhb_0_1/slhb_0_1.h"

#include "gi/core/error.h"
#include "gi/kernel/device.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/automatic/automatic.h"
#include "gi/methods/paths/kernels/kernel_frames.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/paths/lobes.h"
#include "gi/methods/paths/paths.h"
#include "gi/methods/slhb/slhb.h"

namespace gi {
namespace {

/// True if options are set that only look-ups have: they were then taken.
bool has_look_up_options(RenderSettings const& asked)
{
    SlhbSettings const& s = asked.of<SlhbSettings>();
    return s.schedule != Schedule::automatic || !s.directions.empty() || s.resolution > 0 || s.axes > 0 ||
           s.fresh_axes > 0 || s.most_layers > 0 || s.packed || s.cone > 0 || s.gather || s.exact.any();
}

/// True if options are set that only shadow maps have.
bool says_maps(RenderSettings const& asked)
{
    SlhbSettings const& s = asked.of<SlhbSettings>();
    return s.light_samples > 0 || s.fresh_light_samples > 0 || s.shadow_resolution > 0 || s.exact.any();
}

/// One grid for the whole world and no exact rays for doubts, as it was.
RenderSettings as_it_was(RenderSettings settings)
{
    settings.of<SlhbSettings>().levels = 1;
    settings.of<SlhbSettings>().confirm = Confirming::off;
    return settings;
}

PathAlgorithm algorithm_of(RenderSettings const& asked, World const& world, Camera const& camera, RenderUse use)
{
    FormerSlhbSettings const& former = asked.of<FormerSlhbSettings>();
    PathAlgorithm by;
    by.nested = false;
    if (former.look_ups != FormerLookUps::automatic)
        by.surfaces = former.look_ups == FormerLookUps::all ? SurfacesBy::look_ups : SurfacesBy::rays;
    else if (has_look_up_options(asked))
        by.surfaces = SurfacesBy::look_ups;
    else
        by.surfaces = choose_algorithm(world, as_it_was(asked), camera, use).algorithm.surfaces;
    bool const bvh = narrow_somewhere(world) || by.surfaces == SurfacesBy::rays;
    bool const maps = says_maps(asked) || has_look_up_options(asked) || !bvh;
    by.shadows = former.shadows == FormerShadows::maps   ? ShadowsBy::maps
                 : former.shadows == FormerShadows::rays ? ShadowsBy::rays
                 : maps                                  ? ShadowsBy::maps
                                                         : ShadowsBy::rays;
    return by;
}

/// Throws InputError on what the kernels of slhb do not have.
void check_device_options(RenderSettings const& asked)
{
    FormerSlhbSettings const& former = asked.of<FormerSlhbSettings>();
    if (former.look_ups == FormerLookUps::none || former.shadows == FormerShadows::rays)
        throw InputError("--device cuda with look_ups none or shadows rays",
                         "the kernels of slhb find surfaces by look-ups and shadows by maps",
                         "leave them out, or choose --method reference");
    check_device(Space::device);
}

} // namespace

RenderOptionTable const& slhb_0_1_options()
{
    using F = FormerSlhbSettings;
    static RenderOptionTable const all = [] {
        auto const option = [](char const* name, OptionValues values, char const* meaning, auto F::*member,
                               char const* now) {
            RenderOption o{make_option<RenderSettings>(
                               name, std::move(values), meaning,
                               [member](auto& s) -> auto& { return s.template of<F>().*member; }),
                           "Of version 0.1",
                           {"slhb_0_1"}};
            o.replaced_by = now;
            return o;
        };
        return RenderOptionTable{
            option("look-ups", {"auto", "all", "none"}, "how slhb of version 0.1 found surfaces", &F::look_ups,
                   "--method slhb for look-ups, --method paths for exact rays"),
            option("shadows", {"auto", "maps", "rays"}, "how slhb of version 0.1 tested light samples", &F::shadows,
                   "--method slhb or paths_shadow_maps for shadow maps, --method paths or slhb_shadow_rays for rays"),
        };
    }();
    return all;
}

RenderResult render_slhb_0_1(World const& world, Camera const& camera, RenderSettings const& settings,
                             StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    if (settings.space == Space::device) {
        check_device_options(settings);
        lose_lamp_caustics(world, report);
        return render_by_kernels(Space::device, world, camera, as_it_was(settings), stop, progress, report);
    }
    PathAlgorithm const by = algorithm_of(settings, world, camera, RenderUse::picture);
    return render_by("slhb_0_1", world, camera, with(by, settings), stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_slhb_0_1_frames(MovingWorld const& world, Camera const& camera,
                                                     RenderSettings const& settings, Report& report)
{
    if (settings.space == Space::device) {
        check_device_options(settings);
        return start_kernel_frames(Space::device, world, camera, as_it_was(settings), report);
    }
    PathAlgorithm const by = algorithm_of(settings, world.world(), camera, RenderUse::frames);
    return start_frames_by(world, camera, with(by, settings), report);
}

RenderSettings slhb_0_1_for_display(RenderSettings settings)
{
    settings.of<PathsSettings>().cache = RadianceCaching::automatic; // decided for every frame
    settings.of<PathsSettings>().interleave = 1;
    // The same axes for all frames: fresh axes in every frame would flicker.
    bool const look_ups = settings.of<FormerSlhbSettings>().look_ups == FormerLookUps::all ||
                          has_look_up_options(settings) || settings.space == Space::device;
    Schedule& schedule = settings.of<SlhbSettings>().schedule;
    if (look_ups && schedule == Schedule::automatic) schedule = Schedule::stored;
    return settings;
}

ExposurePlan slhb_0_1_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                               Triangles triangles)
{
    if (asked.space == Space::device)
        return {"slhb_0_1", slhb_exposure(world, as_it_was(asked), camera, triangles).settings};
    RenderSettings s = asked;
    SlhbSettings& buffers = s.of<SlhbSettings>();
    // Which made its paths take look-ups.
    if (triangles == Triangles::moving && buffers.schedule == Schedule::automatic && buffers.directions.empty() &&
        buffers.fresh_axes == 0)
        buffers.schedule = Schedule::streamed;
    if (s.budget_s > 0) {
        PathAlgorithm const by = algorithm_of(s, world, camera, RenderUse::picture);
        s = choose_settings(with(by, s), world, make_soup(world));
        s.of<FormerSlhbSettings>() = {
            by.surfaces == SurfacesBy::look_ups ? FormerLookUps::all : FormerLookUps::none,
            by.shadows == ShadowsBy::maps ? FormerShadows::maps : FormerShadows::rays};
    }
    return {"slhb_0_1", s};
}

} // namespace gi
