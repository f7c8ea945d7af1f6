#pragma once
// A GL context as a runtime wants to be told of it. Apart from the rest, since it needs the headers of Xlib and
// EGL.

#include "viewer/devices/gl/context.h"
#include "viewer/devices/xr/runtime.h"

#include <memory>

namespace viewer {

/// Throws InputError on a context that is neither GLX's nor EGL's.
PicturePath path_of(GlContext const& context);
/// What XrSessionCreateInfo::next points to. Checks what the runtime requires of GL first, as it must be asked;
/// throws InputError where this GL is too old for it.
std::shared_ptr<void const> graphics_binding(Runtime const& runtime, GlContext const& context);

} // namespace viewer
