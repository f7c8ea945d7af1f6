// See viewer/devices/gl/wall_pass.h.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 picture_place;
layout(location = 2) in float weight;

uniform float up; // -1 where the target's top row is its first

out vec2 place;
out vec2 at; // on the target
out float vertex_weight;

void main()
{
    place = picture_place;
    at = position;
    vertex_weight = weight;
    vec2 p = 2.0 * position - 1.0;
    gl_Position = vec4(p.x, up * p.y, 0.0, 1.0);
}
