// The light of a surface, found in the newest pictures of light: the rule of gi/surfaces/kept_light.h. Where the newest shows
// nothing similar, older ones are asked, then the pixels around in the newest; what it does not show has the mean light of the last pictures.

layout(binding = 2) uniform usampler2DArray lights; // LightTexel of gi/surfaces/light_picture.h

const int kPictures = 3;
uniform int pictures;
uniform int light_layers[kPictures];
uniform vec3 light_eye[kPictures];           // positions of their cameras
uniform mat3 texel_from_world[kPictures];    // to places in them, times the depth
uniform vec2 texel_at[kPictures];            // where rays pass texels
uniform vec3 mean_light;

const float kAlike = 0.3, kUnlike = 0.01, kLeast = 1e-4, kOfDepth = 0.005; // as KeptLight

vec3 find_light(vec3 at, vec3 n)
{
    vec3 sum = vec3(0.0), weights = vec3(0.0);
    float best = 0.0;
    ivec2 size = textureSize(lights, 0).xy;
    bool shown = true; // by the newest picture
    for (int k = 0; k <= pictures && best <= kAlike; ++k) {
        bool around = k == pictures;
        int picture = around ? 0 : k;
        vec3 from = at - light_eye[picture], h = texel_from_world[picture] * from;
        vec2 u = h.xy / max(h.z, 1e-9) - texel_at[picture];
        bool inside = h.z > 0.0 && all(greaterThan(u, vec2(-1.0))) && all(lessThan(u, vec2(size)));
        if (around) {
            shown = inside;
            u = clamp(u, vec2(0.0), vec2(size - 1)); // beyond its edge, a plane that goes on there
        }
        vec2 whole = floor(u), f = u - whole;
        ivec2 left = inside || around ? ivec2(whole) : ivec2(-8);
        for (int j = 0; j < 4; ++j) {
            ivec2 step = ivec2(j & 1, j >> 1);
            float w = (step.x == 0 ? 1.0 - f.x : f.x) * (step.y == 0 ? 1.0 - f.y : f.y) + 0.02;
            if (around) {
                step = 3 * step - 1; // the corners of the ring
                w = 0.25;
            }
            ivec2 p = left + step;
            bool there = all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, size));
            uvec4 t = texelFetch(lights, ivec3(clamp(p, ivec2(0), size - 1), light_layers[picture]), 0);
            vec3 facing = unpack_normal(t.x);
            vec3 light = unpack_light(t.z);
            float depth = uintBitsToFloat(t.w & ~7u), off = (dot(facing, from) - uintBitsToFloat(t.y)) / (kOfDepth * max(depth, 1e-30));
            float cosine = max(0.0, dot(facing, n)), c2 = cosine * cosine, c4 = c2 * c2, like = c4 * c4 / (1.0 + off * off * off * off);
            w = there && depth > 0.0 ? w * (like + kLeast) : 0.0;
            vec3 by_channel = w * vec3(1u - (uvec3(t.w) >> uvec3(0u, 1u, 2u) & 1u));
            sum += by_channel * light;
            weights += by_channel;
            best = max(best, w > 0.0 ? like : 0.0);
        }
    }
    if (best < kUnlike && !shown) return mean_light; // not that of what happens to be at the edge
    return mix(mean_light, sum / max(weights, vec3(1e-20)), greaterThan(weights, vec3(0.0)));
}
