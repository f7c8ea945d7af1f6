#pragma once
// The panel (Dear ImGui) as a picture, for walls: pointed at by a ray instead of a mouse. Between begin and finish
// the caller fills it as a Panel; what it fills takes the whole picture.

#include "viewer/devices/gl/context.h"
#include "viewer/devices/gl/draw_target.h"

#include <optional>

struct ImGuiContext;

namespace viewer {

class PanelPicture {
public:
    /// @param gl  must be current here and in draw, and outlive it; the destructor makes it current
    /// @param font_px  letter height
    PanelPicture(GlContext const& gl, glm::ivec2 size_px, float font_px);
    ~PanelPicture();
    PanelPicture(PanelPicture const&) = delete;
    PanelPicture& operator=(PanelPicture const&) = delete;

    glm::ivec2 size_px() const { return size_px_; }
    /// Needs no context. Not while another thread draws.
    /// @param pointer_px  from the top left corner; none = nowhere
    /// @param pressed  the trigger is held  @param scroll  steps of a wheel, upward
    /// @param seconds  since the last
    void begin(std::optional<glm::dvec2> pointer_px, bool pressed, double scroll, double seconds);
    void finish();
    /// R, G, B bytes of the finished panel, rows from the top. Waits for the GPU.
    std::vector<unsigned char> draw();

private:
    GlContext const& gl_;
    glm::ivec2 size_px_;
    TextureTarget target_;
    ImGuiContext* context_;
};

} // namespace viewer
