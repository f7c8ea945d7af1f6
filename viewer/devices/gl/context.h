#pragma once
// A context of OpenGL 4.5 core: without a window (EGL, no display server needed), or that of a GLFW window. It is
// current to one thread at a time; whoever draws in another thread moves it there by make_current.

#include "gi/core/report.h"

#include <memory>
#include <string>

struct GLFWwindow;

namespace viewer {

/// EGLDisplay, EGLConfig, EGLContext; null where the context is not EGL's. For XrGraphicsBindingEGLMNDX.
struct EglHandles {
    void* display = nullptr;
    void* config = nullptr;
    void* context = nullptr;
};

/// Display*, GLXFBConfig, GLXContext, GLXDrawable and the id of the visual; null where the context is not GLX's.
/// For XrGraphicsBindingOpenGLXlibKHR.
struct GlxHandles {
    void* display = nullptr;
    void* config = nullptr;
    void* context = nullptr;
    unsigned long drawable = 0;
    unsigned long visual = 0;
};

class GlContext {
public:
    /// Without a window: a GPU that EGL lists, else Mesa's surfaceless platform. It is current when this returns.
    /// OpenGL's errors are counted in the report, which must outlive the context.
    /// Throws InputError with EGL's reasons where there is none.
    static GlContext surfaceless(gi::Report& report);
    /// The context of a window, which stays the owner; made with context_hints(). It is current when this returns.
    /// Throws InputError on a window without OpenGL 4.5.
    static GlContext of_window(GLFWwindow* window, gi::Report& report);
    /// Sets GLFW's hints for windows to OpenGL 4.5 core with messages.
    static void context_hints();

    GlContext(GlContext&&) noexcept;
    GlContext& operator=(GlContext&&) noexcept;
    ~GlContext();

    /// To the calling thread. Throws InputError where the context is current to another one.
    void make_current() const;
    /// From the calling thread, so that another can take it.
    void release() const;

    EglHandles egl() const;
    /// The context must be current.
    GlxHandles glx() const;
    /// "4.5 (Core Profile) Mesa 22.3.6, llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string const& description() const;
    /// Errors that OpenGL reported so far, also those whose text is not kept.
    std::uint64_t errors() const;

private:
    struct State;
    explicit GlContext(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace viewer
