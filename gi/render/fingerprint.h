#pragma once
// A hash of everything that affects the picture, used to refuse checkpoints of another render.

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

#include <string_view>

namespace gi {

/// Hash of geometry, materials, lights, camera and of the settings that affect the value of a path (not of those
/// that only decide the number of paths).
/// @param method  name  @param options  of the method, with all values that the plan has chosen
std::uint64_t fingerprint(World const& world, Camera const& camera, RenderSettings const& settings,
                          std::string_view method, std::string_view options);

} // namespace gi
