#include "viewer/devices/gl/swap_group.h"

#include <epoxy/glx.h>
#include <fmt/format.h>

namespace viewer {

std::string join_swap_group(int group, int barrier)
{
    Display* const display = glXGetCurrentDisplay();
    if (!display) return "no GLX context is current";
    int const screen = DefaultScreen(display);
    if (!epoxy_has_glx_extension(display, screen, "GLX_NV_swap_group"))
        return "the driver has no GLX_NV_swap_group";
    GLuint groups = 0, barriers = 0;
    if (!glXQueryMaxSwapGroupsNV(display, screen, &groups, &barriers)) return "the driver does not say its groups";
    if (GLuint(group) > groups || GLuint(barrier) > barriers)
        return fmt::format("the driver has {} groups and {} barriers", groups, barriers);
    if (!glXJoinSwapGroupNV(display, glXGetCurrentDrawable(), GLuint(group)))
        return fmt::format("the driver refuses group {}", group);
    if (barrier > 0 && !glXBindSwapBarrierNV(display, GLuint(group), GLuint(barrier)))
        return fmt::format("the driver refuses barrier {}", barrier);
    return {};
}

} // namespace viewer
