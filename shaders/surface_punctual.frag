// The fourth pass of viewer/devices/gl/surface_renderer.h: adds the light of punctual light LIGHT where the others lack it.

layout(binding = 1) uniform sampler2D lit_before; // a: the share that lacks it
layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye;
uniform float nearest_m;

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 before = texelFetch(lit_before, pixel, 0);
    uvec4 s = texelFetch(surfaces, pixel, 0);
    vec3 from_eye = nearest_m / texelFetch(depths, pixel, 0).r * (world_from_pixel * vec3(gl_FragCoord.xy, 1.0));
    vec3 at = eye + from_eye, n = unpack_normal(s.x);
    color = vec4(before.rgb + before.a * punctual_of(LIGHT, at, n, -normalize(from_eye), albedo_of(s), gloss_of(s)), before.a);
}
