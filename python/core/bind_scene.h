#pragma once
// Python bindings of scenes and cameras.

#include "gi/scene/model/world.h"

#include <pybind11/pybind11.h>

namespace bindings {

namespace py = pybind11;

/// A scene at one moment, as bound to Python.
struct LoadedWorld {
    std::string name;
    std::shared_ptr<gi::World const> world;
    std::map<std::string, gi::Report::Loss> losses; ///< of loading
};

/// Returns the named camera; if the name is empty, the world's first camera, or one that frames the whole scene if
/// it has none. Throws InputError.
gi::Camera camera_of(gi::World const& world, std::string const& name);

/// Camera, World, load.
void bind_scene(py::module_& m);

} // namespace bindings
