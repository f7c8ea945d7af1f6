#include "viewer/devices/gl/scene_textures.h"

#include <algorithm>
#include <bit>
#include <epoxy/gl.h>

namespace viewer {
namespace {

GLint gl_wrap(gi::Wrap wrap)
{
    return wrap == gi::Wrap::repeat ? GL_REPEAT : wrap == gi::Wrap::clamp ? GL_CLAMP_TO_EDGE : GL_MIRRORED_REPEAT;
}

} // namespace

bool SceneTextures::upload(gi::TexturePool const& pool, std::size_t texture)
{
    GlObject& to = textures_[texture];
    if (to.id() != 0) return false;
    gi::Texture const& from = pool.textures[texture];
    to = GlObject(GlObject::Kind::texture, GL_TEXTURE_2D);
    auto const levels = GLsizei(std::bit_width(std::max(from.width, from.height)));
    glTextureStorage2D(to.id(), from.nearest ? 1 : levels, from.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8,
                       GLsizei(from.width), GLsizei(from.height));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(to.id(), 0, 0, 0, GLsizei(from.width), GLsizei(from.height), GL_RGBA, GL_UNSIGNED_BYTE,
                        pool.texels.data() + from.first);
    glTextureParameteri(to.id(), GL_TEXTURE_MAG_FILTER, from.nearest ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(to.id(), GL_TEXTURE_MIN_FILTER, from.nearest ? GL_NEAREST : GL_LINEAR_MIPMAP_NEAREST);
    glTextureParameteri(to.id(), GL_TEXTURE_WRAP_S, gl_wrap(from.wrap_u));
    glTextureParameteri(to.id(), GL_TEXTURE_WRAP_T, gl_wrap(from.wrap_v));
    if (!from.nearest) glGenerateTextureMipmap(to.id());
    return true;
}

} // namespace viewer
