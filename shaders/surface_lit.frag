// The third pass of viewer/devices/gl/surface_renderer.h: lights what the first one has described. In the first step with what
// the second has found at alike surfaces around; where none is alike, and at edges, where another wall may go on, light is found
// for the pixel alone in the second step. Alpha: the share that lacks punctual light. Depth: 1 = for the second step, 0.5 = for
// surface_punctual.frag, 0 = for neither.

layout(binding = 4) uniform usampler2D surfaces;
layout(binding = 12) uniform sampler2D depths; // nearest_m / depth
#if STEP == 0
layout(binding = 15) uniform usampler2D found; // of surface_found.frag
uniform vec3 behind;    // color where there is no surface
uniform vec4 towards[4]; // punctual lights; a: 1 = their positions
#endif

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye, moved_low, moved_size;
uniform float nearest_m;

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 s = texelFetch(surfaces, pixel, 0);
    float near = texelFetch(depths, pixel, 0).r;
    vec3 ray = world_from_pixel * vec3(gl_FragCoord.xy, 1.0), n = unpack_normal(s.x);
#if STEP == 0
    ivec2 last = textureSize(found, 0) - 1;
    vec3 sum = vec3(0.0);
    float best = 0.0, weights = 0.0, lacks = 0.0;
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
    bool at_edge = newest_pictures > 1 && (any(equal(pixel, ivec2(0))) || any(equal(pixel, textureSize(surfaces, 0) - 1)));
    vec3 light = sum / max(weights, 1e-20);
    float a = lacks / max(3.0 * weights, 1e-20);
    vec3 at = eye + nearest_m / max(near, 1e-30) * ray;
    bool faces_light = false;
    for (int k = 0; k < 4; ++k) faces_light = faces_light || dot(n, towards[k].xyz - towards[k].a * at) > 0.0;
    color = vec4(near > 0.0 ? emission_of(s) + albedo_of(s) * light : behind, a);
    gl_FragDepth = near <= 0.0 ? 0.0 : best < kAlike || at_edge ? 1.0 : a > 0.0 && faces_light ? 0.5 : 0.0;
#else
    vec3 from_eye = nearest_m / near * ray;
    FoundLight f = find_light(has_moved(s) ? moved_low + moved_size * place_in_box(s) : eye + from_eye, n);
    color = vec4(emission_of(s) + albedo_of(s) * turned_to(f, n), f.lacks);
#endif
}
