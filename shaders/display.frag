// See viewer/devices/gl/display_pass.h. Pixels count from the top left of the target. MODE, COMPARISON, CURVE, STRETCHED,
// ENCODED and CALIBRATED are defines, so that only what is asked for is computed.

layout(binding = 0) uniform sampler2D left_picture;
layout(binding = 1) uniform sampler2D right_picture;
layout(binding = 2) uniform sampler2D left_other;
layout(binding = 3) uniform sampler2D right_other;

uniform ivec2 corner, target_size, eye_size, on_screen;
uniform bool top_last;
uniform float scale, split, difference_gain;

layout(binding = 4) uniform sampler2D light_table; // viewer/displays/display_light.h
uniform float light_gain, light_black;

out vec4 color;

const bool kOneEye = MODE == STEREO_off || MODE == STEREO_two_windows || MODE == STEREO_quad_buffer;

vec3 texels(sampler2D picture, ivec2 place)
{
    if (STRETCHED == 0) return texelFetch(picture, place, 0).rgb;
    ivec2 size = textureSize(picture, 0);
    vec2 at = (vec2(place) + 0.5) * vec2(size) / vec2(eye_size) - 0.5;
    ivec2 first = ivec2(floor(at)), last = size - 1;
    vec2 f = at - vec2(first);
    ivec2 a = clamp(first, ivec2(0), last), b = clamp(first + 1, ivec2(0), last);
    vec3 top = mix(texelFetch(picture, a, 0).rgb, texelFetch(picture, ivec2(b.x, a.y), 0).rgb, f.x);
    vec3 bottom = mix(texelFetch(picture, ivec2(a.x, b.y), 0).rgb, texelFetch(picture, b, 0).rgb, f.x);
    // Equal sizes beside others that are stretched: no rounding of 0 weights.
    return size == eye_size ? texelFetch(picture, place, 0).rgb : mix(top, bottom, f.y);
}

/// encode() of display_light.h, for three channels at once.
vec3 of_light(vec3 radiance)
{
    vec3 share = clamp(light_gain * tone_curve(radiance, scale) - light_black, 0.0, 1.0);
    int last = textureSize(light_table, 0).x - 1;
    vec3 at = pow(share, vec3(1.0 / TABLE_EXPONENT)) * float(last);
    ivec3 below = min(ivec3(at), ivec3(last - 1));
    vec3 low, high;
    for (int c = 0; c < 3; ++c) {
        low[c] = texelFetch(light_table, ivec2(below[c], 0), 0)[c];
        high[c] = texelFetch(light_table, ivec2(below[c] + 1, 0), 0)[c];
    }
    return to_bytes(mix(low, high, at - vec3(below)));
}

vec3 display_value(vec3 v)
{
    if (ENCODED == 1) return to_bytes(clamp(v, 0.0, 1.0));
    return CALIBRATED == 1 ? of_light(v) : tone_map(v, scale);
}

/// Of the eye: 0 or 1. Both are read before one is chosen, the curve is applied to the chosen one.
vec3 of_eye(int eye, sampler2D left, sampler2D right, ivec2 place)
{
    vec3 v = texels(left, place);
    if (!kOneEye) v = eye == 0 ? v : texels(right, place);
    return v;
}

vec3 seen_by(int eye, ivec2 place)
{
    if (COMPARISON == COMPARE_OFF) return display_value(of_eye(eye, left_picture, right_picture, place));
    vec3 other = of_eye(eye, left_other, right_other, place);
    if (COMPARISON == COMPARE_OTHER) return display_value(other);
    vec3 v = of_eye(eye, left_picture, right_picture, place);
    if (COMPARISON == COMPARE_SPLIT)
        return display_value(float(place.x) + 0.5 < split * float(eye_size.x) ? v : other);
    return to_bytes(min(abs(display_value(v) - display_value(other)) * difference_gain, 1.0));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    if (top_last) pixel.y = target_size.y - 1 - pixel.y;
    ivec2 place;
    int eye = eye_of(pixel, eye_size, on_screen, place);
    vec3 v;
    if (kAnaglyph)
        v = anaglyph(seen_by(0, place), seen_by(1, place));
    else
        v = eye == 2 ? vec3(0.0) : seen_by(eye, place);
    color = vec4(v, 1.0);
}
