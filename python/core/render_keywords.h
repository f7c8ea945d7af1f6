#pragma once
// Keyword arguments of Python's World.render as settings of the renderer.

#include "gi/filter/denoise.h"
#include "gi/render/render_settings.h"

#include <pybind11/pybind11.h>

namespace bindings {

namespace py = pybind11;

/// Converts the arguments of World.render, checked by the rules of `lightwell render`. Throws InputError.
/// @param k  width, height, paths, budget_s, until_relmse, bounces, seed, threads, filter, state, resume, checkpoint_s;
/// all are required, but paths, budget_s and until_relmse may be None
/// @param options  of the method, by the names of the command line's options, with _ for -: axes, light_paths, ...
gi::RenderSettings settings_of(py::dict const& k, py::dict const& options, std::string const& method);

/// Returns the settings of a filter named as in gi/filter/filter_names.h.
/// Throws InputError if it is unknown or not installed.
gi::DenoiseSettings denoise_of(std::string const& name, gi::RenderSettings const& settings);

} // namespace bindings
