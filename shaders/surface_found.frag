// The second pass of viewer/devices/gl/surface_renderer.h: finds the light of every second pixel of every second row: in the
// newest picture (STEP 0) and, where that shows nothing alike, in all and in cells of space. Depth 1 marks pixels for the second
// step, as software drivers execute all of a shader for every pixel that passes the depth test.

layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye, moved_low, moved_size;
uniform float nearest_m;

#if STEP == 0
uniform int light_before; // picture of the view before the newest; -1 = none
uniform float share;      // of the newest
#endif

out uvec4 found; // light, its LightSlope, and nearest_m / depth, whose last two bits are the share that lacks punctual light

void main()
{
    ivec2 pixel = 2 * ivec2(gl_FragCoord.xy);
    float near = texelFetch(depths, pixel, 0).r;
    uvec4 s = texelFetch(surfaces, pixel, 0);
    vec3 from_eye = nearest_m / max(near, 1e-30) * (world_from_pixel * vec3(vec2(pixel) + 0.5, 1.0));
    vec3 at = has_moved(s) ? moved_low + moved_size * place_in_box(s) : eye + from_eye, n = unpack_normal(s.x);
#if STEP == 0
    Likes likes = kNothingAlike;
    ask(likes, 0, 0, at, n);
    FoundLight f = light_of(likes, n);
#if FADES
    Likes older = kNothingAlike;
    ask(older, max(light_before, 0), 0, at, n);
    FoundLight g = light_of(older, n);
    vec3 now = turned_to(f, n), was = turned_to(g, n);
    float change = abs(dot(now - was, vec3(1.0))) / max(dot(max(now, was), vec3(1.0)), 1e-20);
    // What changes by much, as when a lamp goes out, is followed at once.
    float w = light_before < 0 || older.best <= kAlike || has_moved(s) ? 1.0 : max(share, smoothstep(0.5, 0.8, change));
    f.light *= mix(was, now, w) / max(now, vec3(1e-20));
    f.lacks = mix(g.lacks, f.lacks, w);
#endif
    gl_FragDepth = near > 0.0 && likes.best <= kAlike ? 1.0 : 0.0;
#else
    FoundLight f = find_light(at, n);
#endif
    found = near > 0.0 ? uvec4(pack_light(f.light), f.bent, floatBitsToUint(near) & ~3u | uint(3.0 * f.lacks + 0.5)) : uvec4(0u);
}
