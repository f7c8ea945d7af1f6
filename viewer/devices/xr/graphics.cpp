#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h>
#define XR_USE_PLATFORM_XLIB
#define XR_USE_PLATFORM_EGL
#include "viewer/devices/xr/graphics.h"

#include "gi/core/error.h"

#include <fmt/format.h>

namespace viewer {

PicturePath path_of(GlContext const& context)
{
    if (context.egl().context) return PicturePath::egl;
    if (context.glx().context) return PicturePath::glx;
    throw gi::InputError("the OpenGL context is neither GLX's nor EGL's", "OpenXR knows these two on Linux",
                         "open the window under X11");
}

std::shared_ptr<void const> graphics_binding(Runtime const& runtime, GlContext const& context)
{
    XrGraphicsRequirementsOpenGLKHR required{};
    required.type = XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR;
    auto const ask =
        runtime.function<PFN_xrGetOpenGLGraphicsRequirementsKHR>("xrGetOpenGLGraphicsRequirementsKHR");
    check(ask(runtime.instance(), runtime.system(), &required), "xrGetOpenGLGraphicsRequirementsKHR");
    XrVersion const have = XR_MAKE_VERSION(epoxy_gl_version() / 10, epoxy_gl_version() % 10, 0);
    if (have < required.minApiVersionSupported)
        throw gi::InputError(fmt::format("the OpenXR runtime needs OpenGL {}.{}",
                                         XR_VERSION_MAJOR(required.minApiVersionSupported),
                                         XR_VERSION_MINOR(required.minApiVersionSupported)),
                             "this context has " + context.description(), "use a newer driver");

    if (path_of(context) == PicturePath::egl) {
        auto const egl = std::make_shared<XrGraphicsBindingEGLMNDX>();
        EglHandles const handles = context.egl();
        egl->type = XR_TYPE_GRAPHICS_BINDING_EGL_MNDX;
        // Its type changed between OpenXR 1.0.20 and 1.1.
        egl->getProcAddress = reinterpret_cast<decltype(egl->getProcAddress)>(eglGetProcAddress);
        egl->display = handles.display;
        egl->config = handles.config;
        egl->context = handles.context;
        return egl;
    }
    auto const glx = std::make_shared<XrGraphicsBindingOpenGLXlibKHR>();
    GlxHandles const handles = context.glx();
    glx->type = XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR;
    glx->xDisplay = static_cast<Display*>(handles.display);
    glx->visualid = static_cast<std::uint32_t>(handles.visual);
    glx->glxFBConfig = static_cast<GLXFBConfig>(handles.config);
    glx->glxDrawable = handles.drawable;
    glx->glxContext = static_cast<GLXContext>(handles.context);
    return glx;
}

} // namespace viewer
