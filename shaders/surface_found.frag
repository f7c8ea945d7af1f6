// The second pass of viewer/devices/gl/surface_renderer.h: finds the light of every second pixel of every second row.

layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye, moved_low, moved_size;
uniform float nearest_m;

out uvec4 found; // light, its LightSlope, and nearest_m / depth, whose last two bits are the share that lacks punctual light

void main()
{
    ivec2 pixel = 2 * ivec2(gl_FragCoord.xy);
    float near = texelFetch(depths, pixel, 0).r;
    uvec4 s = texelFetch(surfaces, pixel, 0);
    found = uvec4(0u);
    for (int once = 0; once < 1 && near > 0.0; ++once) {
        vec3 from_eye = nearest_m / near * (world_from_pixel * vec3(vec2(pixel) + 0.5, 1.0));
        FoundLight f = find_light(has_moved(s) ? moved_low + moved_size * place_in_box(s) : eye + from_eye, unpack_normal(s.x));
        found = uvec4(pack_light(f.light), f.bent, floatBitsToUint(near) & ~3u | uint(3.0 * f.lacks + 0.5));
    }
}
