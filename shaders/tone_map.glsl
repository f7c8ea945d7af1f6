// gi/filter/tone_map.h, for three channels at once. Values come back as whole bytes / 255, as the CPU makes them.

vec3 encode_srgb(vec3 v)
{
    return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
}

vec3 decode_srgb(vec3 v)
{
    return mix(pow((v + 0.055) / 1.055, vec3(2.4)), v / 12.92, lessThanEqual(v, vec3(0.04045)));
}

vec3 to_bytes(vec3 v) { return floor(v * 255.0 + 0.5) / 255.0; }

/// Exposure and curve, without clipping at white. NaN becomes 0: it is not greater than anything.
vec3 tone_curve(vec3 radiance, float scale)
{
    vec3 v = radiance * scale;
    v = mix(vec3(0.0), min(v, vec3(1e6)), greaterThan(v, vec3(0.0)));
    if (CURVE == CURVE_FILMIC) v = v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14);
    return v;
}

vec3 tone_map(vec3 radiance, float scale) { return to_bytes(encode_srgb(min(tone_curve(radiance, scale), vec3(1.0)))); }
