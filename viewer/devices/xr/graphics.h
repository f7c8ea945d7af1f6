#pragma once
// Graphics bindings that pass a GL context to a runtime. Separate, because they need the headers of Xlib and EGL.

#include "viewer/devices/gl/context.h"
#include "viewer/devices/xr/runtime.h"

#include <memory>

namespace viewer {

/// Throws InputError if the context is neither GLX's nor EGL's.
PicturePath path_of(GlContext const& context);
/// Value for XrSessionCreateInfo::next. First queries the runtime's GL requirements, as OpenXR demands; throws
/// InputError if this GL is too old.
std::shared_ptr<void const> graphics_binding(Runtime const& runtime, GlContext const& context);

} // namespace viewer
