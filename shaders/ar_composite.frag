// See viewer/devices/gl/ar_composite_pass.h and ar/composite/composite.cpp, whose arithmetic this is, step by step. Pixels
// count from the top left of the target. RATIO, CLIPPED and NOISE are defines.

layout(binding = 0) uniform sampler2D camera_picture; // RGB8: bytes
layout(binding = 1) uniform sampler2D with_picture;
layout(binding = 2) uniform sampler2D without_picture;
layout(binding = 3) uniform sampler2D coverage_picture;
layout(binding = 4) uniform sampler2D response; // byte x channel: unit, border, least, most
layout(binding = 5) uniform usampler2D cells;    // cell of unit x channel: a byte that is not above the nearest
layout(binding = 6) uniform sampler2D noise_tile;
layout(binding = 7) uniform sampler2D direct_picture;

uniform ivec2 corner, target_size, noise_offset;
uniform bool top_last, has_direct;
uniform mat3 to_unit;
uniform vec3 vignetting;
uniform vec3 noise_constant, noise_per_unit;
uniform vec3 cells_per_unit;
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
    float first = texelFetch(response, ivec2(0, channel), 0).x, last = texelFetch(response, ivec2(255, channel), 0).x;
    if (!(unit > first)) return 0;
    if (unit >= last) return 255;
    int b = int(texelFetch(cells, ivec2(int((unit - first) * cells_per_unit[channel]), channel), 0).r);
    while (b < 255 && unit > texelFetch(response, ivec2(b, channel), 0).y) ++b;
    return b;
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
    bool parted = has_direct && a > 0.0 && a < 1.0;
    vec3 d = vec3(0.0);
    if (parted) {
        vec3 direct = texelFetch(direct_picture, pixel, 0).rgb;
        if (!is_finite(direct)) return;
        d = left * (to_unit * direct);
        w = (w - d) / (1.0 - a);
    }
    ivec3 bytes = ivec3(camera * 255.0 + 0.5);
    vec3 random = vec3(0.0);
    if (NOISE == 1) random = texelFetch(noise_tile, (pixel + noise_offset) % textureSize(noise_tile, 0), 0).rgb;
    for (int c = 0; c < 3; ++c) {
        int b = bytes[c];
        vec4 own = texelFetch(response, ivec2(b, c), 0);
        float u = own.x;
        float v = blended(u, w[c], n[c], parted ? 0.0 : a, b == 255);
        v = max(parted ? d[c] + (1.0 - a) * v : v, 0.0);
        if (NOISE == 1) {
            float there = (1.0 - a) * (1.0 - a) * (noise_constant[c] + noise_per_unit[c] * max(u, 0.0));
            v += sqrt(max(0.0, noise_constant[c] + noise_per_unit[c] * v - there)) * random[c];
        }
        bool kept = a < 1.0 && v >= own.z && v <= own.w;
        if (!kept) b = byte_of(v, c);
        color[c] = float(b) / 255.0;
    }
}
