// See viewer/devices/gl/shadow_maps.h.

layout(location = 0) in vec3 position_in;
layout(location = 3) in vec2 uv0_in;
layout(location = 4) in vec2 uv1_in;
layout(location = 8) in float alpha_in;

uniform mat4 clip_from_world;

#if MAPS
out vec2 uv0, uv1;
#endif
#if ALPHAS
out float vertex_alpha;
#endif

void main()
{
    gl_Position = clip_from_world * vec4(position_in, 1.0);
#if MAPS
    uv0 = uv0_in;
    uv1 = uv1_in;
#endif
#if ALPHAS
    vertex_alpha = alpha_in;
#endif
}
