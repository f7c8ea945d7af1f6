// The fourth pass of viewer/devices/gl/surface_renderer.h: punctual light LIGHT, to be added where the others lack it, which
// the alpha there says.

layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye;
uniform float nearest_m;

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 s = texelFetch(surfaces, pixel, 0);
    vec3 from_eye = nearest_m / texelFetch(depths, pixel, 0).r * (world_from_pixel * vec3(gl_FragCoord.xy, 1.0));
    color = vec4(punctual_of(LIGHT, eye + from_eye, unpack_normal(s.x), -normalize(from_eye), albedo_of(s), gloss_of(s)), 0.0);
}
