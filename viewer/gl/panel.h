#pragma once
// The place of the panel (Dear ImGui) in a window: between begin and end the caller fills it by ImGui's functions,
// end draws it over what the window shows. Without one, windows are only pictures.

#include "viewer/gl/window.h"

struct ImGuiContext;

namespace viewer {

class Panel {
public:
    /// Listens to the window's input beside its queue. One panel in the program at a time: ImGui's callbacks know
    /// no other. The window must outlive it, and its context must be current here and at the end.
    explicit Panel(Window& window);
    ~Panel();
    Panel(Panel const&) = delete;
    Panel& operator=(Panel const&) = delete;

    /// The window's context must be current.
    void begin();
    /// Draws into the window's back buffer, over all of it.
    void end();
    /// Marks the events that the panel takes for itself: keys while a text is typed, the mouse over it. Releases
    /// go to both, so that nothing stays held.
    void claim(std::vector<InputEvent>& events) const;

private:
    ImGuiContext* context_;
};

} // namespace viewer
