#include "viewer/devices/xr/eye_pass.h"

#include <epoxy/gl.h>
#include <stdexcept>
#include <string>

namespace viewer {
namespace {

constexpr char const* kVertex = R"(#version 450 core
layout(location = 0) uniform bool first_row_is_top;
out vec2 position;
void main()
{
    vec2 corner = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1); // one triangle covers the viewport
    position = 0.5 * corner + 0.5;
    if (first_row_is_top) position.y = 1 - position.y;
    gl_Position = vec4(corner, 0, 1);
}
)";

// IEC 61966-2-1.
constexpr char const* kFragment = R"(#version 450 core
layout(location = 1) uniform bool decode;
layout(binding = 0) uniform sampler2D picture;
in vec2 position;
out vec4 colour;
void main()
{
    vec3 c = texture(picture, position).rgb;
    if (decode) c = mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
    colour = vec4(c, 1);
}
)";

GLuint compile(GLenum stage, char const* source)
{
    GLuint const shader = glCreateShader(stage);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    return shader;
}

/// Saves the GL state that draw changes, and restores it.
class SavedState {
public:
    SavedState()
    {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
        glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
        glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertices_);
        glGetIntegerv(GL_VIEWPORT, viewport_);
        glGetIntegerv(GL_ACTIVE_TEXTURE, &unit_);
        glActiveTexture(GL_TEXTURE0);
        glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
        glGetIntegerv(GL_SAMPLER_BINDING, &sampler_);
        glGetBooleanv(GL_COLOR_WRITEMASK, mask_);
        for (std::size_t i = 0; i < std::size(kSwitches); ++i) on_[i] = glIsEnabled(kSwitches[i]);
    }
    ~SavedState()
    {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(framebuffer_));
        glUseProgram(GLuint(program_));
        glBindVertexArray(GLuint(vertices_));
        glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
        glBindTexture(GL_TEXTURE_2D, GLuint(texture_));
        glBindSampler(0, GLuint(sampler_));
        glActiveTexture(GLenum(unit_));
        glColorMask(mask_[0], mask_[1], mask_[2], mask_[3]);
        for (std::size_t i = 0; i < std::size(kSwitches); ++i)
            on_[i] ? glEnable(kSwitches[i]) : glDisable(kSwitches[i]);
    }
    SavedState(SavedState const&) = delete;
    SavedState& operator=(SavedState const&) = delete;

    static constexpr GLenum kSwitches[] = {
        GL_BLEND,     GL_DEPTH_TEST,       GL_SCISSOR_TEST,      GL_STENCIL_TEST,
        GL_CULL_FACE, GL_FRAMEBUFFER_SRGB, GL_RASTERIZER_DISCARD};

private:
    GLint framebuffer_ = 0, program_ = 0, vertices_ = 0, unit_ = 0, texture_ = 0, sampler_ = 0;
    GLint viewport_[4] = {};
    GLboolean mask_[4] = {};
    GLboolean on_[std::size(kSwitches)] = {};
};

} // namespace

EyePass::EyePass()
{
    GLuint const vertex = compile(GL_VERTEX_SHADER, kVertex), fragment = compile(GL_FRAGMENT_SHADER, kFragment);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex);
    glAttachShader(program_, fragment);
    glLinkProgram(program_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint linked = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (!linked) {
        char log[1024] = "";
        glGetProgramInfoLog(program_, sizeof log, nullptr, log);
        glDeleteProgram(program_);
        throw std::runtime_error(std::string("the pass for the eyes of a headset: ") + log);
    }
    glCreateVertexArrays(1, &vertices_);
    glCreateFramebuffers(1, &framebuffer_);
    glCreateSamplers(1, &sampler_);
    glSamplerParameteri(sampler_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(sampler_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(sampler_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(sampler_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

EyePass::~EyePass()
{
    glDeleteSamplers(1, &sampler_);
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteVertexArrays(1, &vertices_);
    glDeleteProgram(program_);
}

void EyePass::draw(unsigned texture, TextureValues values, FirstRow first_row, Target const& target) const
{
    SavedState const saved;
    for (GLenum const what : SavedState::kSwitches) glDisable(what);
    bool const keep_code = values == TextureValues::srgb && target.is_srgb;
    if (target.is_srgb && !keep_code) glEnable(GL_FRAMEBUFFER_SRGB);
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, target.texture, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, target.width, target.height);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glUseProgram(program_);
    glUniform1i(0, first_row == FirstRow::top);
    glUniform1i(1, values == TextureValues::srgb && !keep_code);
    glBindTextureUnit(0, texture);
    glBindSampler(0, sampler_);
    glBindVertexArray(vertices_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);
}

} // namespace viewer
