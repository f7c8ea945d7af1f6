#pragma once
// A shader program. Each stage is the concatenation of files from shaders/, after "#version 450 core".

#include "viewer/devices/gl/gl_object.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <string>

namespace viewer {

class GlProgram {
public:
    using Files = std::initializer_list<char const*>;
    /// @param defines lines put before both stages ("#define MODE_OFF 0\n")
    /// Throws std::runtime_error with the compiler's log; this indicates a bug in this program or the driver.
    GlProgram(Files vertex, Files fragment, std::string const& defines = {});

    void use() const;
    /// Sets a uniform; uniforms removed by the compiler as unused are ignored.
    void set(char const* name, int value) const;
    void set(char const* name, float value) const;
    void set(char const* name, glm::ivec2 value) const;
    void set(char const* name, glm::vec2 value) const;
    void set(char const* name, glm::vec3 value) const;
    void set(char const* name, glm::vec4 value) const;
    void set(char const* name, glm::mat3 const& value) const;
    void set(char const* name, glm::mat4 const& value) const;

private:
    int location(char const* name) const;
    GlObject program_{GlObject::Kind::program};
};

} // namespace viewer
