#pragma once
// What a light-transport method is to everything outside gi/methods: functions that render with it, its options, and
// the few traits by which front ends treat methods differently. Nothing else asks for a method's name.

#include "gi/render/frame_renderer.h"
#include "gi/render/render_option.h"
#include "gi/scene/model/plan.h"

#include <string_view>

namespace gi {

using RenderFunction = RenderResult (*)(World const&, Camera const&, RenderSettings const&, StopRequest const&,
                                        RenderProgress const&, Report&);

/// What a method builds for a world and what it does not, each with the reason; traces a few rays at most.
using ExplainMethod = std::vector<PlanItem> (*)(World const&, RenderSettings const&, Camera const&);

enum class RenderUse : std::uint8_t {
    picture, ///< one, within a budget that includes building all structures
    frames   ///< many, of which each has the budget; structures are built once
};

/// A method that the plan has chosen.
struct MethodChoice {
    std::string_view method;
    PlanText why;
};

/// A picture with motion blur, which a FrameRenderer renders with the budget of a single picture.
struct ExposurePlan {
    std::string_view method;
    RenderSettings settings; ///< with the choices for that budget
    PlanText why = "";       ///< of a method that chooses another
};
enum class Triangles : std::uint8_t { still, moving };

struct Method {
    std::string_view name;
    std::string_view summary; ///< one line for --help
    RenderFunction render;
    StartFrames frames;
    RenderOptionTable const& (*options)() = nullptr; ///< of its own; nullptr = none
    ExplainMethod explain = nullptr;                 ///< nullptr = it has no plan by the scene

    bool offered = true; ///< to people; else only for files of earlier versions
    /// FrameRenderer::views may be stopped after any path: frames with as many paths are then the same.
    bool ends_frames_early = false;
    bool pairs = false; ///< frames on the CPU are PairFrames: scenes with and without objects, as AR needs them
    /// The option whose value is appended to the name in measurements, such as "slhb:stored"; empty = none.
    std::string_view variant = {};
    /// How the key `visibility` of studies names it; empty = not at all.
    std::string_view visibility = {};
    /// A method that stands for others chooses one of them; nullptr for all others.
    MethodChoice (*choose)(World const&, RenderSettings const&, Camera const&, RenderUse) = nullptr;
    /// Settings of frames that are shown to people one after another; nullptr = as asked.
    RenderSettings (*for_display)(RenderSettings) = nullptr;
    /// nullptr = the method itself, with the settings as asked.
    ExposurePlan (*for_exposure)(World const&, RenderSettings const&, Camera const&, Triangles) = nullptr;
    /// True if viewers decide for each frame how many stored axes follow dynamic geometry; nullptr = never.
    bool (*updates_axes)(RenderSettings const&) = nullptr;
    /// Throws InputError if options contradict each other. @param given  names of those that the user set
    void (*check)(std::vector<std::string> const& given, RenderSettings const&) = nullptr;
};

inline bool updates_axes(Method const& method, RenderSettings const& settings)
{
    return method.updates_axes != nullptr && method.updates_axes(settings);
}

} // namespace gi
