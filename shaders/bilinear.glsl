// Bilinear filtering without the rounding of texture units: exact at the middles of pixels.
// Places are 0..1 from the lower left; textures have their top row first.

const float kSnap = 1.0 / 256; // px: as near to a pixel's middle as this is at it

vec4 bilinear(sampler2D from, vec2 at)
{
    ivec2 last = textureSize(from, 0) - 1;
    vec2 u = vec2(at.x, 1.0 - at.y) * vec2(last + 1) - 0.5, whole = floor(u + kSnap);
    vec2 f = u - whole;
    f = mix(f, vec2(0.0), lessThan(f, vec2(kSnap)));
    ivec2 a = clamp(ivec2(whole), ivec2(0), last), b = clamp(ivec2(whole) + 1, ivec2(0), last);
    vec4 top = mix(texelFetch(from, a, 0), texelFetch(from, ivec2(b.x, a.y), 0), f.x);
    vec4 bottom = mix(texelFetch(from, ivec2(a.x, b.y), 0), texelFetch(from, b, 0), f.x);
    return mix(top, bottom, f.y);
}
