#pragma once
// Targets of passes: windows and textures. Pictures in textures always have the top row first; windows have it
// last, as in OpenGL. Passes handle both.

#include "viewer/devices/gl/gl_object.h"

#include <glm/vec2.hpp>
#include <vector>

namespace viewer {

class Window;

enum class RowOrder { top_last, top_first };

/// A rectangle of a window or of a texture.
struct DrawTarget {
    unsigned framebuffer = 0; ///< OpenGL's name; 0 = the window whose context is current
    glm::ivec2 corner_px{};   ///< of the rectangle, in OpenGL coordinates (first row, first column)
    glm::ivec2 size_px{};
    RowOrder rows = RowOrder::top_last;
    /// Buffers of the eyes (GL_BACK_LEFT, GL_BACK_RIGHT); 0 = none, the current draw buffer is used.
    unsigned left_buffer = 0, right_buffer = 0;
};

DrawTarget target_of(Window const& window);
/// Part of the target; its top left corner is relative to that of the whole.
DrawTarget part_of(DrawTarget const& whole, glm::ivec2 top_left_px, glm::ivec2 size_px);
/// Binds it, sets the viewport, and disables what passes do not use (blending, depth, scissors).
void bind(DrawTarget const& target);
/// Fills exactly this rectangle with one grey. @param grey  display-encoded, 0..1
void clear(DrawTarget const& target, float grey = 0);
/// Copies one into the other, stretched (bilinear).
void stretch(DrawTarget const& from, DrawTarget const& to);
/// R, G, B bytes, rows from the top for any row order of the target, as gi::write_png expects.
/// For a window call it before the swap, which makes the back buffer undefined. `buffer`:
/// 0 = the current draw buffer. Waits for the GPU.
std::vector<unsigned char> read_bytes(DrawTarget const& target, unsigned buffer = 0);

/// A picture shown by a pass.
struct ShownPicture {
    unsigned texture = 0; ///< top row first; 0 = none
    glm::ivec2 size_px{};
};

/// A texture to draw into.
class TextureTarget {
public:
    /// bytes: display-encoded RGBA8; linear: RGBA32F; words: RGBA32UI.
    enum class Format { bytes, linear, words };
    TextureTarget(Format format, glm::ivec2 size_px);
    DrawTarget target() const;
    ShownPicture shown() const { return {texture_.id(), size_px_}; }

private:
    glm::ivec2 size_px_;
    GlObject texture_, framebuffer_;
};

} // namespace viewer
