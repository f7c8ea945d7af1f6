#pragma once
// Conversions between Python and C++ types.

#include "gi/core/report.h"
#include "gi/image_io/picture.h"
#include "gi/scene/model/camera.h"

#include <array>
#include <nlohmann/json.hpp>
#include <pybind11/pybind11.h>

namespace bindings {

namespace py = pybind11;
using Point = std::array<double, 3>;

inline gi::dvec3 to_vec(Point const& p) { return {p[0], p[1], p[2]}; }
inline Point to_point(gi::dvec3 v) { return {v.x, v.y, v.z}; }

/// Layer name -> array, height x width x channels, or height x width where there is one channel. Takes the layers.
py::dict to_layers(gi::Picture&& picture);
/// The inverse, copied. Throws InputError unless all layers are float32 arrays of the same size.
gi::Picture to_picture(py::dict const& layers);

/// Counts of everything skipped, clamped or missing, by name.
py::dict losses_of(gi::Report const& report);

/// Converts None, bool, int, float, str, and lists and tuples of these. Throws InputError on other types.
nlohmann::json to_json(py::handle value);
py::object from_json(nlohmann::json const& value);

} // namespace bindings
