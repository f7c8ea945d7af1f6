#pragma once
// Table of the light-transport methods by name, with their options. One entry makes a method available on the
// command line, in benchmarks, in viewers, in studies, in Python and in --help.

#include "gi/render/frame_renderer.h"
#include "gi/render/render_option.h"
#include "gi/scene/model/plan.h"

#include <span>
#include <string_view>

namespace gi {

using RenderFunction = RenderResult (*)(World const&, Camera const&, RenderSettings const&, StopRequest const&,
                                        RenderProgress const&, Report&);

/// What a method builds for a world and what it does not, each with the reason; traces a few rays at most.
using ExplainMethod = std::vector<PlanItem> (*)(World const&, RenderSettings const&, Camera const&);

struct Method {
    std::string_view name;
    std::string_view summary; ///< one line for --help
    RenderFunction render;
    StartFrames frames;
    RenderOptionTable const& (*options)() = nullptr; ///< of its own; nullptr = none
    ExplainMethod explain = nullptr;                 ///< nullptr = it has no plan by the scene
};

std::span<Method const> methods();
std::vector<std::string> method_names();
/// Throws InputError, listing the known methods.
Method const& find_method(std::string_view name);

/// The options of all methods, common ones first.
RenderOptionTable const& render_options();
/// nullptr if none has this name, key or former key.
RenderOption const* find_render_option(std::string_view name);
/// The option of this name, which must be in the table.
RenderOption const& render_option(std::string_view name);

/// A method that will render.
struct ChosenMethod {
    std::string name;
    Schedule schedule = Schedule::automatic;
    std::string as_given; ///< how the user chose the schedule: "--schedule stored"
};

/// Throws InputError if none of the methods (at least one) reads one of the options, or if they contradict.
/// @param given  names of the options that the user set  @param settings  their values
void check_options(std::vector<std::string> const& given, RenderSettings const& settings,
                   std::vector<ChosenMethod> const& methods);

} // namespace gi
