// See viewer/devices/gl/surface_pass.h.

layout(binding = 0) uniform sampler2D points; // xyz: place in the room, w 1; or direction, w 0; w < 0: dark
layout(binding = 1) uniform sampler2D front;
layout(binding = 2) uniform sampler2D left;
layout(binding = 3) uniform sampler2D right;
layout(binding = 4) uniform sampler2D up;
layout(binding = 5) uniform sampler2D down;
layout(binding = 6) uniform sampler2D back;

uniform vec3 eye;            // in the room
uniform mat3 cube_from_room;
uniform vec4 tangents_front, tangents_left, tangents_right, tangents_up, tangents_down, tangents_back;
uniform vec2 corner_px;      // of the target's first pixel in the window
uniform vec2 size_px;
uniform float is_top_last;   // 1 where the target's first row is the lowest

out vec4 color;

// tangents: left, right, bottom, top; all 0 = the face is not there.
vec3 seen(sampler2D face, vec4 tangents, vec2 t)
{
    if (tangents.x == tangents.y) return vec3(0.0);
    vec2 at = (t - tangents.xz) / (tangents.yw - tangents.xz);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return vec3(0.0);
    return bilinear(face, at).rgb;
}

void main()
{
    vec2 at = floor(gl_FragCoord.xy - corner_px);
    ivec2 pixel = ivec2(at.x, is_top_last > 0.5 ? size_px.y - 1.0 - at.y : at.y);
    vec4 point = texelFetch(points, pixel, 0);
    color = vec4(0.0, 0.0, 0.0, 1.0);
    if (point.w < 0.0) return;
    vec3 d = cube_from_room * (point.xyz - point.w * eye), a = abs(d);
    vec3 v;
    if (a.z >= a.x && a.z >= a.y)
        v = d.z < 0.0 ? seen(front, tangents_front, d.xy / a.z)
                      : seen(back, tangents_back, vec2(-d.x, d.y) / a.z);
    else if (a.x >= a.y)
        v = d.x < 0.0 ? seen(left, tangents_left, vec2(-d.z, d.y) / a.x)
                      : seen(right, tangents_right, vec2(d.z, d.y) / a.x);
    else
        v = d.y > 0.0 ? seen(up, tangents_up, vec2(d.x, d.z) / a.y)
                      : seen(down, tangents_down, vec2(d.x, -d.z) / a.y);
    color = vec4(to_bytes(v), 1.0);
}
