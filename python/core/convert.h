#pragma once
// Small things between Python and the program.

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
/// The inverse, copied. Throws InputError on layers that are no float32 arrays of one size.
gi::Picture to_picture(py::dict const& layers);

/// What was skipped, clamped or missing -> how often.
py::dict losses_of(gi::Report const& report);

/// None, bool, int, float, str, and lists and tuples of them. Throws InputError on anything else.
nlohmann::json to_json(py::handle value);
py::object from_json(nlohmann::json const& value);

} // namespace bindings
