#include "viewer/devices/gl/sync_control.h"

#include <epoxy/glx.h>

namespace viewer {

bool sync_control_listed()
{
    Display* const display = glXGetCurrentDisplay();
    return display && epoxy_has_glx_extension(display, DefaultScreen(display), "GLX_OML_sync_control");
}

std::optional<SwapCount> swaps_so_far()
{
    std::int64_t ust = 0, msc = 0, sbc = 0;
    if (!glXGetSyncValuesOML(glXGetCurrentDisplay(), glXGetCurrentDrawable(), &ust, &msc, &sbc)) return {};
    return SwapCount{ust, sbc};
}

std::optional<SwapCount> wait_for_swaps()
{
    std::int64_t ust = 0, msc = 0, sbc = 0;
    if (!glXWaitForSbcOML(glXGetCurrentDisplay(), glXGetCurrentDrawable(), 0, &ust, &msc, &sbc)) return {};
    return SwapCount{ust, sbc};
}

} // namespace viewer
