#pragma once
// The place of the panel (Dear ImGui) in a window: between begin and finish the caller fills it by ImGui's
// functions, draw draws it over what the window shows. Without one, windows are only pictures.

#include "viewer/devices/gl/window.h"

struct ImGuiContext;

namespace viewer {

class Panel {
public:
    /// Listens to the window's input beside its queue. One panel in the program at a time: ImGui's callbacks know
    /// no other. The window must outlive it, and its context must be current here; it is so after the end, too.
    /// @param font_px  height of its letters; 0 = small ones for tools
    explicit Panel(Window& window, float font_px = 0);
    ~Panel();
    Panel(Panel const&) = delete;
    Panel& operator=(Panel const&) = delete;

    /// By the thread of the window's events; no context is needed. Not while another thread draws.
    void begin();
    void finish();
    /// What was finished last, into the window's back buffer, over all of it. The window's context is current to
    /// the calling thread, which may be another one.
    void draw();
    /// Marks the events that the panel takes for itself: keys while a text is typed, the mouse over it. Releases
    /// go to both, so that nothing stays held.
    void claim(std::vector<InputEvent>& events) const;

private:
    Window const& window_;
    ImGuiContext* context_;
};

} // namespace viewer
