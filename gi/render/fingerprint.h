#pragma once
// A number that changes with whatever changes the picture, to refuse checkpoints of another render.

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

#include <string_view>

namespace gi {

/// Hash of geometry, materials, lights, camera and of those settings that decide the value of every path (not of
/// those that decide how many paths there are).
/// @param method by name
std::uint64_t fingerprint(World const& world, Camera const& camera, RenderSettings const& settings,
                          std::string_view method);

} // namespace gi
