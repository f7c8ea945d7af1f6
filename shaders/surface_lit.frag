// The second pass of viewer/devices/gl/surface_renderer.h: lights what the first one has described.

layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye, moved_low, moved_size;
uniform float nearest_m;

out vec4 color;

void main()
{
    uvec4 s = texelFetch(surfaces, ivec2(gl_FragCoord.xy), 0);
    vec3 from_eye = nearest_m / texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r * (world_from_pixel * vec3(gl_FragCoord.xy, 1.0));
    vec3 n = unpack_normal(s.x), albedo = albedo_of(s);
    vec4 light = find_light(has_moved(s) ? moved_low + moved_size * place_in_box(s) : eye + from_eye, n);
    color = vec4(emission_of(s) + albedo * light.rgb, 1.0);
#if PUNCTUAL
    if (light.a > 0.0) color.rgb += light.a * punctual_light(eye + from_eye, n, -normalize(from_eye), albedo, gloss_of(s));
#endif
}
