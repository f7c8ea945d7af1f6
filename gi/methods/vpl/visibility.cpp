#include "gi/methods/vpl/visibility.h"

#include "gi/hit_buffers/directions/stored_axes.h"
#include "gi/hit_buffers/options.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/vpl/renderer.h"
#include "gi/methods/vpl/settings.h"

#include <array>
#include <fmt/format.h>

namespace gi {
namespace {

/// Names by VisibilityKind.
constexpr std::array<char const*, 6> kNames{"vpl_exact", "vpl_slhb", "vpl_imperfect",
                                            "vpl_ao",    "vpl_dao",  "vpl_none"};

/// Settings as command-line options that reproduce the picture.
std::string options_of(VisibilityKind kind, RenderSettings const& s)
{
    std::vector<std::string_view> own{"light-paths"};
    if (s.of<VirtualLightSettings>().near_m > 0) own.push_back("near");
    if (kind == VisibilityKind::imperfect) own.insert(own.end(), {"points", "point-map"});
    if (kind == VisibilityKind::ambient || kind == VisibilityKind::directional) own.push_back("ao-radius");
    std::string const text = as_options(virtual_light_options(), s, own);
    if (kind != VisibilityKind::slhb) return text;
    std::vector<std::string_view> names{"directions", "hit-buffer"};
    if (s.of<SlhbSettings>().most_layers > 0) names.push_back("max-layers");
    return text + " " + as_options(hit_buffer_options(), s, names);
}

/// Returns the settings with defaults chosen.
RenderSettings chosen(RenderSettings settings)
{
    settings.of<SlhbSettings>() = with_stored_axes(settings.of<SlhbSettings>());
    settings.of<VirtualLightSettings>().points = settings.of<VirtualLightSettings>().points_per_map();
    settings.of<VirtualLightSettings>().points_percent = 0;
    return settings;
}

StartPasses passes(VisibilityKind kind)
{
    return [kind](World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                  StopRequest const* stop) {
        return std::make_unique<VirtualLightRenderer>(kind, world, settings, first_moving, report, stop);
    };
}

} // namespace

std::string VirtualLightRenderer::options() const { return options_of(kind_, settings_); }

RenderResult render_with_virtual_lights(VisibilityKind kind, World const& world, Camera const& camera,
                                        RenderSettings const& settings, StopRequest const& stop,
                                        RenderProgress const& progress, Report& report)
{
    lose_lamp_caustics(world, report);
    return render_passes(kNames[std::size_t(kind)], passes(kind), world, camera, chosen(settings), stop, progress,
                         report);
}

std::unique_ptr<FrameRenderer> start_virtual_light_frames(VisibilityKind kind, MovingWorld const& world,
                                                          RenderSettings const& settings, Report& report)
{
    return start_pass_frames(passes(kind), world, chosen(settings), report);
}

} // namespace gi
