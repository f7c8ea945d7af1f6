#include "viewer/devices/gl/context.h"

#include "gi/core/error.h"
#include "viewer/devices/gl/messages.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <vector>

namespace viewer {

GlxHandles current_glx_handles(); // in glx_handles.cpp, to keep Xlib's macros there

namespace {

struct EglContext {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLConfig config = nullptr;
    EGLContext context = EGL_NO_CONTEXT;
};

char const* egl_error()
{
    switch (eglGetError()) {
    case EGL_SUCCESS:
        return "no reason given";
    case EGL_NOT_INITIALIZED:
        return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
        return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
        return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
        return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
        return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
        return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
        return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
        return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
        return "EGL_BAD_PARAMETER";
    default:
        return "another EGL error";
    }
}

struct NamedDisplay {
    std::string name;
    EGLDisplay display;
};

/// GPUs first, then software.
std::vector<NamedDisplay> surfaceless_displays()
{
    std::vector<NamedDisplay> displays;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        eglQueryDevicesEXT(16, devices, &count);
        for (EGLint i = 0; i < count; ++i) {
            char const* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
            if (extensions && std::string(extensions).find("software") != std::string::npos) continue;
            displays.push_back({fmt::format("device {}", i),
                                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
        }
    }
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        displays.push_back({"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                                                    EGL_DEFAULT_DISPLAY, nullptr)});
    return displays;
}

/// Creates a context; returns the error, empty on success. Displays belong to the process and are never
/// terminated, because other contexts, also those of an OpenXR runtime, may use the same one.
std::string open_context(EGLDisplay display, EglContext& out)
{
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY) return "no display";
    if (!eglInitialize(display, &major, &minor)) return std::string("eglInitialize: ") + egl_error();
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return "no EGL_KHR_surfaceless_context";
    if (!eglBindAPI(EGL_OPENGL_API)) return std::string("no desktop OpenGL: ") + egl_error();
    EGLint const wanted[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint configs = 0;
    if (!eglChooseConfig(display, wanted, &out.config, 1, &configs) || configs == 0)
        return std::string("no config with desktop OpenGL: ") + egl_error();
    EGLint const attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 EGL_TRUE,
                                 EGL_NONE};
    out.context = eglCreateContext(display, out.config, EGL_NO_CONTEXT, attributes);
    if (out.context == EGL_NO_CONTEXT) return std::string("no OpenGL 4.5 core: ") + egl_error();
    out.display = display;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, out.context)) return {};
    std::string const why = std::string("eglMakeCurrent: ") + egl_error();
    eglDestroyContext(display, out.context);
    return why;
}

std::string text(GLenum what)
{
    auto const* s = reinterpret_cast<char const*>(glGetString(what));
    return s ? s : "?";
}

} // namespace

struct GlContext::State {
    EglContext egl;
    GLFWwindow* window = nullptr;
    std::unique_ptr<GlMessages> messages;
    std::string description;

    ~State()
    {
        if (window && glfwGetCurrentContext() == window) glDebugMessageCallback(nullptr, nullptr);
        if (egl.context == EGL_NO_CONTEXT) return;
        if (eglGetCurrentContext() == egl.context)
            eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(egl.display, egl.context);
    }

    void start(gi::Report& report)
    {
        messages = std::make_unique<GlMessages>(report);
        description = text(GL_VERSION) + ", " + text(GL_RENDERER);
    }
};

GlContext::GlContext(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;
GlContext::~GlContext() = default;

GlContext GlContext::surfaceless(gi::Report& report)
{
    auto state = std::make_unique<State>();
    std::string reasons;
    for (NamedDisplay const& d : surfaceless_displays()) {
        std::string const why = open_context(d.display, state->egl);
        if (why.empty()) {
            state->start(report);
            return GlContext(std::move(state));
        }
        state->egl = {};
        reasons += (reasons.empty() ? "" : "; ") + d.name + ": " + why;
    }
    throw gi::InputError("there is no OpenGL 4.5 without a window",
                         reasons.empty() ? "EGL offers neither devices nor the surfaceless platform" : reasons,
                         "install a driver with EGL (Debian: libegl1 and libgl1-mesa-dri)");
}

void GlContext::context_hints()
{
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
}

GlContext GlContext::of_window(GLFWwindow* window, gi::Report& report)
{
    auto state = std::make_unique<State>();
    state->window = window;
    glfwMakeContextCurrent(window);
    if (glfwGetCurrentContext() != window || epoxy_gl_version() < 45 || !epoxy_is_desktop_gl())
        throw gi::InputError("the window has no OpenGL 4.5", "the display passes need it",
                             "use a driver with OpenGL 4.5 (Mesa's llvmpipe has it)");
    state->start(report);
    return GlContext(std::move(state));
}

void GlContext::make_current() const
{
    EglContext const& egl = state_->egl;
    bool done = false;
    if (state_->window) {
        glfwMakeContextCurrent(state_->window);
        done = glfwGetCurrentContext() == state_->window;
    } else {
        // The API is per thread.
        done =
            eglBindAPI(EGL_OPENGL_API) && eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl.context);
    }
    if (!done)
        throw gi::InputError("an OpenGL context cannot be made current", "another thread holds it",
                             "release it there first");
}

void GlContext::release() const
{
    if (state_->window)
        glfwMakeContextCurrent(nullptr);
    else
        eglMakeCurrent(state_->egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

EglHandles GlContext::egl() const { return {state_->egl.display, state_->egl.config, state_->egl.context}; }

GlxHandles GlContext::glx() const { return state_->window ? current_glx_handles() : GlxHandles{}; }

bool GlContext::is_software() const
{
    return std::ranges::any_of(std::array{"llvmpipe", "softpipe", "swrast"}, [&](char const* driver) {
        return state_->description.find(driver) != std::string::npos;
    });
}

std::string const& GlContext::description() const { return state_->description; }

std::uint64_t GlContext::errors() const { return state_->messages->errors(); }

} // namespace viewer
