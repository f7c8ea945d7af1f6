// See viewer/devices/gl/surface_renderer.h.

layout(location = 0) in vec3 position_in; // from the world's origin
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec4 tangent_in;
layout(location = 3) in vec2 uv0_in;
layout(location = 4) in vec2 uv1_in;
layout(location = 5) in vec3 color_in;
layout(location = 6) in vec3 lit_position_in; // where its light was found
layout(location = 7) in vec3 lit_normal_in;
layout(location = 8) in float alpha_in;

uniform mat3 clip_from_world; // to x, y and w
uniform vec3 eye;
uniform float nearest_m;
uniform vec4 kept; // plane before which surfaces are drawn: normal, distance from the world's origin (GL_CLIP_DISTANCE0)

invariant gl_Position;

out vec3 from_eye, normal;
#if MAPS
out vec2 uv0, uv1;
#endif
#if MAPS & 4
out vec4 tangent;
#endif
#if COLORS
out vec3 vertex_color;
#endif
#if ALPHAS
out float vertex_alpha;
#endif
#if MOVES
out vec3 lit_position, lit_normal;
#endif

void main()
{
    from_eye = position_in - eye;
    vec3 c = clip_from_world * from_eye;
    gl_Position = vec4(c.xy, nearest_m, c.z); // depth nearest / distance: 0 is infinitely far
    gl_ClipDistance[0] = dot(kept.xyz, position_in) - kept.w;
    normal = normal_in;
#if MAPS
    uv0 = uv0_in;
    uv1 = uv1_in;
#endif
#if MAPS & 4
    tangent = tangent_in;
#endif
#if COLORS
    vertex_color = color_in;
#endif
#if ALPHAS
    vertex_alpha = alpha_in;
#endif
#if MOVES
    lit_position = lit_position_in;
    lit_normal = lit_normal_in;
#endif
}
