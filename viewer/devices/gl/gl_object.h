#pragma once
// Owns one name of OpenGL. Made, used and destroyed where its context is current.

#include <cstdint>
#include <glm/vec2.hpp>
#include <utility>

namespace viewer {

class GlObject {
public:
    enum class Kind : std::uint8_t { texture, buffer, framebuffer, vertex_array, program };

    GlObject() = default;
    /// Makes a new one. @param texture_target  GL_TEXTURE_2D, ...; read for textures
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

/// A texture without mipmaps, clamped to its borders. @param format  GL_RGBA8, ...  @param filter  GL_NEAREST or
/// GL_LINEAR
GlObject texture_2d(unsigned format, glm::ivec2 size_px, unsigned filter);

} // namespace viewer
