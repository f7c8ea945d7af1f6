#include "gi/methods/registry.h"

#include "gi/core/error.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/slhb/frames.h"
#include "gi/methods/slhb/options.h"
#include "gi/methods/slhb/slhb.h"
#include "gi/methods/vpl/options.h"
#include "gi/methods/vpl/visibility.h"

#include <array>
#include <string>

namespace gi {
namespace {

template <VisibilityKind kind>
constexpr Method virtual_lights(std::string_view name, std::string_view summary)
{
    return {name, summary, render_visibility<kind>, start_visibility_frames<kind>, false, virtual_light_options};
}

constexpr std::array kMethods{
    Method{"reference", "path tracing with exact rays (Embree): slow, unbiased, for comparison", render_reference,
           start_reference_frames, true},
    Method{"slhb", "path tracing through spherical layered hit buffers: look-ups instead of rays", render_slhb,
           start_slhb_frames, true, slhb_options},
    virtual_lights<VisibilityKind::exact>(
        "vpl_exact", "virtual point lights for indirect light, visibility by exact rays; the other vpl_*\n"
                     "    methods differ only in how they find visibility"),
    virtual_lights<VisibilityKind::slhb>("vpl_slhb", "... by look-ups in spherical layered hit buffers"),
    virtual_lights<VisibilityKind::imperfect>("vpl_imperfect", "... by imperfect shadow maps, drawn from points"),
    virtual_lights<VisibilityKind::ambient>("vpl_ao", "... by ambient occlusion within a radius"),
    virtual_lights<VisibilityKind::directional>("vpl_dao", "... by directional occlusion within a radius"),
    virtual_lights<VisibilityKind::none>("vpl_none", "... none: every surface sees every other"),
};

} // namespace

std::span<Method const> methods() { return kMethods; }

Method const& find_method(std::string_view name)
{
    std::string known;
    for (Method const& m : kMethods) {
        if (m.name == name) return m;
        known += (known.empty() ? "" : ", ") + std::string(m.name);
    }
    throw InputError("there is no method '" + std::string(name) + "'", "it is not in the registry",
                     "choose one of: " + known);
}

} // namespace gi
