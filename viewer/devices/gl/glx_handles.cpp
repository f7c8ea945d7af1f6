#include "viewer/devices/gl/context.h"

#include <epoxy/glx.h>

namespace viewer {

GlxHandles current_glx_handles()
{
    // In a process without libGL, this query makes libepoxy end the process.
    GLXContext const context = glXGetCurrentContext();
    if (!context) return {};
    Display* const display = glXGetCurrentDisplay();
    GlxHandles out{display, nullptr, context, glXGetCurrentDrawable(), 0};
    int id = 0, screen = 0, count = 0;
    glXQueryContext(display, context, GLX_FBCONFIG_ID, &id);
    glXQueryContext(display, context, GLX_SCREEN, &screen);
    int const wanted[] = {GLX_FBCONFIG_ID, id, None};
    GLXFBConfig* const configs = glXChooseFBConfig(display, screen, wanted, &count);
    if (configs && count > 0) {
        int visual = 0;
        glXGetFBConfigAttrib(display, configs[0], GLX_VISUAL_ID, &visual);
        out.config = configs[0];
        out.visual = static_cast<unsigned long>(visual);
    }
    if (configs) XFree(configs);
    return out;
}

} // namespace viewer
