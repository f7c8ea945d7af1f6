#pragma once
// The panel (Dear ImGui) in a window: between begin and finish the caller fills it with ImGui functions; draw
// draws it over the window's content.

#include "viewer/devices/gl/window.h"

struct ImGuiContext;

namespace viewer {

/// Whether a panel takes part in its window's input: buttons and texts, or only shows something.
enum class PanelInput { taken, none };

/// Letter height, px, on a monitor of this content scale (1 = about 96 px per inch).
float panel_font_px(float content_scale);

class Panel {
public:
    /// With PanelInput::taken it receives the window's input in addition to its event queue, by callbacks of ImGui
    /// that are global: then it must be the only panel. Of others there may be one for each window. The window
    /// must outlive it, and its context must be current here; the destructor leaves it current too. @param font_px
    /// letter height; 0 = small, for tools
    explicit Panel(Window& window, float font_px = 0, PanelInput input = PanelInput::taken);
    ~Panel();
    Panel(Panel const&) = delete;
    Panel& operator=(Panel const&) = delete;

    /// Call on the thread of the window's events; needs no context. Not while another thread draws.
    void begin();
    void finish();
    /// Draws the last finished panel over the window's back buffer. The window's context must be current to the
    /// calling thread, which may be a different one.
    void draw();
    /// Marks the events that the panel uses: keys while text is typed, the mouse over it. Releases go to both
    /// panel and scene, so that nothing stays held.
    void claim(std::vector<InputEvent>& events) const;

private:
    Window const& window_;
    ImGuiContext* context_;
};

/// Adds a font that is readable from a distance to the current ImGui context.
void add_panel_font(float px);

} // namespace viewer
