#pragma once
// Table of the light-transport methods by name. One entry makes a method available on the command line, in
// benchmarks, in studies and in --help.

#include "gi/render/frame_renderer.h"
#include "gi/render/render_option.h"

#include <span>
#include <string_view>

namespace gi {

using RenderFunction = RenderResult (*)(World const&, Camera const&, RenderSettings const&, StopRequest const&,
                                        RenderProgress const&, Report&);

struct Method {
    std::string_view name;
    std::string_view summary; ///< one line for --help
    RenderFunction render;
    StartFrames frames;
    bool motion_vectors = false; ///< its frames have the layer "motion", which temporal reuse needs
    RenderOptionTable const& (*options)() = nullptr; ///< of its own; nullptr = none
};

std::span<Method const> methods();
/// Throws InputError, listing the known methods.
Method const& find_method(std::string_view name);

} // namespace gi
