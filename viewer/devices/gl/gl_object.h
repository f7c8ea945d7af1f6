#pragma once
// Owns one OpenGL object. Its context must be current when it is created, used and destroyed.

#include <cstdint>
#include <glm/vec2.hpp>
#include <utility>

namespace viewer {

class GlObject {
public:
    enum class Kind : std::uint8_t { texture, buffer, framebuffer, vertex_array, program, time };

    GlObject() = default;
    /// Creates an object. @param texture_target  GL_TEXTURE_2D, ...; used for textures only
    explicit GlObject(Kind kind, unsigned texture_target = 0);
    GlObject(GlObject&& o) noexcept : kind_(o.kind_), id_(std::exchange(o.id_, 0)) {}
    GlObject& operator=(GlObject&& o) noexcept
    {
        std::swap(kind_, o.kind_);
        std::swap(id_, o.id_);
        return *this;
    }
    ~GlObject();

    unsigned id() const { return id_; } ///< 0 = none

private:
    Kind kind_ = Kind::texture;
    unsigned id_ = 0;
};

/// Creates a texture without mipmaps, clamped to its edges. @param format  GL_RGBA8, ...  @param filter
/// GL_NEAREST or GL_LINEAR
GlObject texture_2d(unsigned format, glm::ivec2 size_px, unsigned filter);

} // namespace viewer
