#pragma once
// Where a pass draws, and what can be drawn into and shown again. Pictures in textures have their top row first,
// whoever made them; windows have it last, as OpenGL wants. Passes know both.

#include "viewer/devices/gl/gl_object.h"

#include <glm/vec2.hpp>
#include <vector>

namespace viewer {

class Window;

enum class RowOrder { top_last, top_first };

/// A rectangle of a window or of a texture.
struct DrawTarget {
    unsigned framebuffer = 0; ///< OpenGL's name; 0 = the window whose context is current
    glm::ivec2 corner_px{};   ///< of the rectangle, in OpenGL's coordinates (first row, first column)
    glm::ivec2 size_px{};
    RowOrder rows = RowOrder::top_last;
    /// Buffers of the eyes (GL_BACK_LEFT, GL_BACK_RIGHT); 0 = there are none, and all goes where it goes.
    unsigned left_buffer = 0, right_buffer = 0;
};

DrawTarget target_of(Window const& window);
/// A part, by its top left corner counted from that of the whole.
DrawTarget part_of(DrawTarget const& whole, glm::ivec2 top_left_px, glm::ivec2 size_px);
/// Binds it, sets the viewport, and switches off what passes do not use (blending, depth, scissors).
void bind(DrawTarget const& target);
/// All of it, and nothing else, in one grey. @param grey  display-encoded, 0..1
void clear(DrawTarget const& target, float grey = 0);
/// R, G, B in bytes, rows from the top, whatever the order of the target's rows: what gi::write_png takes. Of a
/// window before the swap; afterwards nobody knows what its back buffer holds. `buffer`: 0 = the one that is drawn
/// into. Waits for the GPU.
std::vector<unsigned char> read_bytes(DrawTarget const& target, unsigned buffer = 0);

/// A picture that a pass shows.
struct ShownPicture {
    unsigned texture = 0; ///< top row first; 0 = none
    glm::ivec2 size_px{};
};

/// A texture that is drawn into.
class TextureTarget {
public:
    /// bytes: display-encoded RGBA8; linear: RGBA32F.
    enum class Format { bytes, linear };
    TextureTarget(Format format, glm::ivec2 size_px);
    DrawTarget target() const;
    ShownPicture shown() const { return {texture_.id(), size_px_}; }

private:
    glm::ivec2 size_px_;
    GlObject texture_, framebuffer_;
};

} // namespace viewer
