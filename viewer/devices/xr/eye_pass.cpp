#include "viewer/devices/xr/eye_pass.h"

#include <epoxy/gl.h>
#include <stdexcept>
#include <string>

namespace viewer {
namespace {

constexpr char const* kVertex = R"(
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
constexpr char const* kFragment = R"(
layout(location = 1) uniform bool decode;
layout(location = 2) uniform bool depth_in_alpha;
layout(location = 3) uniform float depth_scale;
layout(binding = 1) uniform sampler2D depths;
layout(binding = 0) uniform sampler2D picture;
in vec2 position;
out vec4 colour;
void main()
{
    vec3 c = texture(picture, position).rgb;
    if (decode) c = mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
    colour = vec4(c, 1);
#if DEPTH
    vec4 d = texture(depths, position);
    gl_FragDepth = min(depth_scale * (depth_in_alpha ? d.a : d.r), 1.0);
#endif
}
)";

GLuint compile(GLenum stage, char const* defines, char const* source)
{
    GLuint const shader = glCreateShader(stage);
    char const* const parts[] = {"#version 450 core\n", defines, source};
    glShaderSource(shader, 3, parts, nullptr);
    glCompileShader(shader);
    return shader;
}

GLuint linked(char const* defines)
{
    GLuint const vertex = compile(GL_VERTEX_SHADER, defines, kVertex),
                 fragment = compile(GL_FRAGMENT_SHADER, defines, kFragment), program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint done = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &done);
    if (done) return program;
    char log[1024] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    glDeleteProgram(program);
    throw std::runtime_error(std::string("the pass for the eyes of a headset: ") + log);
}

GLuint sampler(GLint filter)
{
    GLuint made = 0;
    glCreateSamplers(1, &made);
    for (GLenum const which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glSamplerParameteri(made, which, filter);
    for (GLenum const axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glSamplerParameteri(made, axis, GL_CLAMP_TO_EDGE);
    return made;
}

} // namespace

EyePass::EyePass() : program_(linked("#define DEPTH 0\n"))
{
    try {
        with_depth_ = linked("#define DEPTH 1\n");
    } catch (...) {
        glDeleteProgram(program_);
        throw;
    }
    glCreateVertexArrays(1, &vertices_);
    glCreateFramebuffers(1, &framebuffer_);
    smooth_ = sampler(GL_LINEAR);
    exact_ = sampler(GL_NEAREST);
}

EyePass::~EyePass()
{
    for (unsigned const sampler : {smooth_, exact_}) glDeleteSamplers(1, &sampler);
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteVertexArrays(1, &vertices_);
    for (unsigned const program : {program_, with_depth_}) glDeleteProgram(program);
}

void EyePass::draw(unsigned texture, TextureValues values, FirstRow first_row, Target const& target,
                   ShownDepth const& depth) const
{
    for (GLenum const what :
         {GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB})
        glDisable(what);
    bool const keep_code = values == TextureValues::srgb && target.is_srgb;
    bool const has_depth = depth.texture != 0 && target.depth_texture != 0;
    if (target.is_srgb && !keep_code) glEnable(GL_FRAMEBUFFER_SRGB);
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, target.texture, 0);
    if (has_depth) glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, target.depth_texture, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, target.width, target.height);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glUseProgram(has_depth ? with_depth_ : program_);
    glUniform1i(0, first_row == FirstRow::top);
    glUniform1i(1, values == TextureValues::srgb && !keep_code);
    if (has_depth) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_ALWAYS);
        glDepthMask(GL_TRUE);
        glUniform1i(2, depth.in_alpha);
        glUniform1f(3, kNear_m * depth.per_m);
        glBindTextureUnit(1, depth.texture);
        glBindSampler(1, exact_);
    }
    glBindTextureUnit(0, texture);
    glBindSampler(0, smooth_);
    glBindVertexArray(vertices_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);
    glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, 0, 0);
    for (GLuint const unit : {0u, 1u}) glBindSampler(unit, 0);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
}

} // namespace viewer
