#include "viewer/devices/gl/gl_program.h"

#include "viewer/devices/gl/shader_source.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>
#include <string>

namespace viewer {
namespace {

struct Shader {
    GLuint id;
    explicit Shader(GLenum stage) : id(glCreateShader(stage)) {}
    ~Shader() { glDeleteShader(id); }
    Shader(Shader const&) = delete;
    Shader& operator=(Shader const&) = delete;
};

std::string joined(GlProgram::Files files, std::string const& defines, std::string& names)
{
    std::string text = "#version 450 core\n" + defines;
    int number = 0;
    for (char const* const file : files) {
        std::string_view const part = shader_source(file);
        if (part.empty()) throw std::logic_error(std::string("there is no shader ") + file);
        names += std::to_string(number) + " = " + file + " ";
        text += "#line 1 " + std::to_string(number++) + "\n" + std::string(part) + "\n";
    }
    return text;
}

void compile(Shader const& shader, GlProgram::Files files, std::string const& defines)
{
    std::string names;
    std::string const text = joined(files, defines, names);
    char const* const start = text.c_str();
    glShaderSource(shader.id, 1, &start, nullptr);
    glCompileShader(shader.id);
    GLint done = 0;
    glGetShaderiv(shader.id, GL_COMPILE_STATUS, &done);
    if (done) return;
    char log[4000] = "";
    glGetShaderInfoLog(shader.id, sizeof log, nullptr, log);
    throw std::runtime_error("a shader does not compile (" + names + "): " + log);
}

} // namespace

GlProgram::GlProgram(Files vertex, Files fragment, std::string const& defines)
{
    Shader const v(GL_VERTEX_SHADER), f(GL_FRAGMENT_SHADER);
    compile(v, vertex, defines);
    compile(f, fragment, defines);
    glAttachShader(program_.id(), v.id);
    glAttachShader(program_.id(), f.id);
    glLinkProgram(program_.id());
    glDetachShader(program_.id(), v.id);
    glDetachShader(program_.id(), f.id);
    GLint done = 0;
    glGetProgramiv(program_.id(), GL_LINK_STATUS, &done);
    if (done) return;
    char log[4000] = "";
    glGetProgramInfoLog(program_.id(), sizeof log, nullptr, log);
    throw std::runtime_error(std::string("shaders do not link (") + *(fragment.end() - 1) + "): " + log);
}

void GlProgram::use() const { glUseProgram(program_.id()); }
int GlProgram::location(char const* name) const { return glGetUniformLocation(program_.id(), name); }
void GlProgram::set(char const* name, int v) const { glProgramUniform1i(program_.id(), location(name), v); }
void GlProgram::set(char const* name, float v) const { glProgramUniform1f(program_.id(), location(name), v); }
void GlProgram::set(char const* name, glm::ivec2 v) const
{
    glProgramUniform2i(program_.id(), location(name), v.x, v.y);
}
void GlProgram::set(char const* name, glm::vec2 v) const
{
    glProgramUniform2f(program_.id(), location(name), v.x, v.y);
}
void GlProgram::set(char const* name, glm::vec3 v) const
{
    glProgramUniform3f(program_.id(), location(name), v.x, v.y, v.z);
}
void GlProgram::set(char const* name, glm::vec4 v) const
{
    glProgramUniform4f(program_.id(), location(name), v.x, v.y, v.z, v.w);
}
void GlProgram::set(char const* name, glm::mat3 const& v) const
{
    glProgramUniformMatrix3fv(program_.id(), location(name), 1, GL_FALSE, glm::value_ptr(v));
}
void GlProgram::set(char const* name, glm::mat4 const& v) const
{
    glProgramUniformMatrix4fv(program_.id(), location(name), 1, GL_FALSE, glm::value_ptr(v));
}

} // namespace viewer
