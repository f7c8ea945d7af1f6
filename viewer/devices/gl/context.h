#pragma once
// A context of OpenGL 4.5 core: without a window (EGL, no display server needed), or that of a GLFW window. It is
// current to one thread at a time; to draw in another thread, move it there with make_current.

#include "gi/core/report.h"

#include <memory>
#include <string>

struct GLFWwindow;

namespace viewer {

/// EGLDisplay, EGLConfig, EGLContext; null if the context is not EGL's. For XrGraphicsBindingEGLMNDX.
struct EglHandles {
    void* display = nullptr;
    void* config = nullptr;
    void* context = nullptr;
};

/// Display*, GLXFBConfig, GLXContext, GLXDrawable and the id of the visual; null if the context is not GLX's.
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
    /// Creates a context without a window, on a GPU listed by EGL, else on Mesa's surfaceless platform, and makes
    /// it current. OpenGL errors are counted in the report, which must outlive the context. Throws InputError with
    /// EGL's reasons if none can be created.
    static GlContext surfaceless(gi::Report& report);
    /// The context of a window created with context_hints(), which remains the owner. Makes it current. Throws
    /// InputError if the window has no OpenGL 4.5.
    static GlContext of_window(GLFWwindow* window, gi::Report& report);
    /// Sets GLFW's window hints to OpenGL 4.5 core with debug messages.
    static void context_hints();

    GlContext(GlContext&&) noexcept;
    GlContext& operator=(GlContext&&) noexcept;
    ~GlContext();

    /// Makes the context current to the calling thread. Throws InputError if it is current to another thread.
    void make_current() const;
    /// Releases the context from the calling thread, so that another thread can take it.
    void release() const;

    EglHandles egl() const;
    /// The context must be current.
    GlxHandles glx() const;
    /// Draws on the processor.
    bool is_software() const;
    /// "4.5 (Core Profile) Mesa 22.3.6, llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string const& description() const;
    /// Number of OpenGL errors so far, including those whose text is not kept.
    std::uint64_t errors() const;

private:
    struct State;
    explicit GlContext(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace viewer
