// The third pass of viewer/devices/gl/surface_renderer.h: lights what the first one has described, with what the second has
// found at alike surfaces around; where none is alike, and at edges, where another wall may go on, light is found for the pixel alone.

layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth
layout(binding = 15) uniform usampler2D found; // of surface_found.frag

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye, moved_low, moved_size;
uniform float nearest_m;

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(found, 0) - 1;
    uvec4 s = texelFetch(surfaces, pixel, 0);
    float near = texelFetch(depths, pixel, 0).r, best = 0.0, weights = 0.0, lacks = 0.0;
    vec3 ray = world_from_pixel * vec3(gl_FragCoord.xy, 1.0), n = unpack_normal(s.x), albedo = albedo_of(s), sum = vec3(0.0);
    for (int j = 0; j < 4; ++j) {
        ivec2 q = min((pixel >> 1) + (pixel & ivec2(j, j >> 1) & 1), last);
        uvec4 t = texelFetch(found, q, 0);
        vec3 facing = unpack_normal(t.y), there = ray + world_from_pixel * vec3(vec2(2 * q - pixel), 0.0);
        // Its plane at this pixel, as KeptLight.
        float near_t = uintBitsToFloat(t.w & ~3u), off = dot(facing, ray * (near_t / near) - there) / kOfDepth;
        float cosine = max(0.0, dot(facing, n)), c2 = cosine * cosine, c4 = c2 * c2;
        float like = near_t > 0.0 ? c4 * c4 / (1.0 + off * off * off * off) : 0.0;
        sum += like * turned(t.z, facing, n) * unpack_light(t.x);
        lacks += like * float(t.w & 3u);
        weights += like;
        best = max(best, like);
    }
    FoundLight f = FoundLight(sum / max(weights, 1e-20), uvec2(pack_normal(n), kNoSlope), lacks / max(3.0 * weights, 1e-20));
    vec3 from_eye = nearest_m / near * ray;
    bool at_edge = newest_pictures > 1 && (any(equal(pixel, ivec2(0))) || any(equal(pixel, textureSize(surfaces, 0) - 1)));
    for (int once = 0; once < 1 && (best < kAlike || at_edge); ++once)
        f = find_light(has_moved(s) ? moved_low + moved_size * place_in_box(s) : eye + from_eye, n);
    color = vec4(emission_of(s) + albedo * turned_to(f, n), 1.0);
#if PUNCTUAL
    if (f.lacks > 0.0) color.rgb += f.lacks * punctual_light(eye + from_eye, n, -normalize(from_eye), albedo, gloss_of(s));
#endif
}
