// See viewer/gl/ar_composite_pass.h and ar/composite/composite.cpp, whose arithmetic this is, step by step. Pixels
// count from the top left of the target. RATIO, CLIPPED and NOISE are defines.

layout(binding = 0) uniform sampler2D camera_picture; // RGB8: bytes
layout(binding = 1) uniform sampler2D with_picture;
layout(binding = 2) uniform sampler2D without_picture;
layout(binding = 3) uniform sampler2D coverage_picture;
layout(binding = 4) uniform sampler2D response; // 256 x 4: units, borders, least, most of each byte
layout(binding = 5) uniform sampler2D noise_tile;

uniform ivec2 corner, target_size, noise_offset;
uniform bool top_last;
uniform mat3 to_unit;
uniform vec3 vignetting;
uniform vec3 noise_constant, noise_per_unit;
uniform float largest_ratio;

out vec4 color;

bool is_finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

float fall_off(ivec2 pixel)
{
    vec2 size = vec2(target_size), d = vec2(pixel) + 0.5 - 0.5 * size;
    float r2 = 4.0 * dot(d, d) / dot(size, size);
    return 1.0 + r2 * (vignetting.x + r2 * (vignetting.y + r2 * vignetting.z));
}

/// The byte whose unit is nearest: the first whose border is not below.
int byte_of(float unit, int channel)
{
    if (!(unit > texelFetch(response, ivec2(0, 0), 0)[channel])) return 0;
    if (unit >= texelFetch(response, ivec2(255, 0), 0)[channel]) return 255;
    int low = 0, high = 255;
    for (int i = 0; i < 8; ++i) {
        int middle = (low + high) / 2;
        bool beyond = unit > texelFetch(response, ivec2(middle, 1), 0)[channel];
        low = beyond && low < high ? middle + 1 : low;
        high = beyond ? high : middle;
    }
    return low;
}

float blended(float u, float w, float n, float a, bool clipped)
{
    if (a >= 1.0) return w;
    bool at_limit = clipped && w < n && CLIPPED != CLIPPED_AS_MEASURED;
    float seen = at_limit && CLIPPED == CLIPPED_MODEL ? max(u, n) : u;
    if (a > 0.0) return w + (1.0 - a) * (seen - n);
    if ((at_limit || RATIO == 1) && w != n && n > 0.0 && w >= 0.0 && w <= largest_ratio * n) return seen * (w / n);
    return seen + (w - n);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    if (top_last) pixel.y = target_size.y - 1 - pixel.y;
    vec3 camera = texelFetch(camera_picture, pixel, 0).rgb;
    color = vec4(camera, 1.0);
    vec3 with = texelFetch(with_picture, pixel, 0).rgb, without = texelFetch(without_picture, pixel, 0).rgb;
    float a = texelFetch(coverage_picture, pixel, 0).r;
    if (isnan(a)) return;
    a = clamp(a, 0.0, 1.0);
    if (a == 0.0 && with == without) return;
    if (!is_finite(with) || (a < 1.0 && !is_finite(without))) return;
    float left = fall_off(pixel);
    vec3 w = left * (to_unit * with), n = left * (to_unit * without);
    ivec3 bytes = ivec3(camera * 255.0 + 0.5);
    vec3 random = vec3(0.0);
    if (NOISE == 1) random = texelFetch(noise_tile, (pixel + noise_offset) % textureSize(noise_tile, 0), 0).rgb;
    for (int c = 0; c < 3; ++c) {
        int b = bytes[c];
        float u = texelFetch(response, ivec2(b, 0), 0)[c];
        float v = max(blended(u, w[c], n[c], a, b == 255), 0.0);
        if (NOISE == 1) {
            float there = (1.0 - a) * (1.0 - a) * (noise_constant[c] + noise_per_unit[c] * max(u, 0.0));
            v += sqrt(max(0.0, noise_constant[c] + noise_per_unit[c] * v - there)) * random[c];
        }
        bool kept = a < 1.0 && v >= texelFetch(response, ivec2(b, 2), 0)[c] && v <= texelFetch(response, ivec2(b, 3), 0)[c];
        color[c] = float(kept ? b : byte_of(v, c)) / 255.0;
    }
}
