// See viewer/devices/gl/reprojection.h. All positions are pixels of picture A from its top left; w = 1 / depth. SEARCHES is a
// define, 0 where B stands where A stood.

layout(binding = 0) uniform sampler2D picture; // radiance and w, 0 = no surface
layout(binding = 1) uniform sampler2D around;  // of tiles: least and greatest w of the tile and those beside it

uniform mat3 a_from_b;
uniform vec3 b_in_a;
uniform float nearest; // greatest w in the picture

const int kSteps = 6;          // of each search
const float kClose = 0.05;     // px: no further step
const float kConverged = 0.5;  // px: taken as a solution
const float kSame = 0.1;       // relative difference of w within one surface
const int kWalk = 12;          // steps beside a hole
const float kSnap = 1.0 / 256; // px: positions this near to a pixel's centre count as its centre

vec2 inside(vec2 x) { return clamp(x, vec2(0.5), vec2(textureSize(picture, 0)) - 0.5); }

/// Pixel whose centre is left of and above x, and the distance of x from it; 0 if x hardly differs from it.
ivec2 cell(vec2 x, out vec2 f)
{
    vec2 u = x - 0.5, whole = floor(u + kSnap);
    f = u - whole;
    f = mix(f, vec2(0.0), lessThan(f, vec2(kSnap)));
    return ivec2(whole);
}

/// Weights of the next row and column: 0 or 1 where the four pixels, whose w are given, show several surfaces.
vec2 weights(vec2 f, vec4 w)
{
    float most = max(max(w.x, w.y), max(w.z, w.w)), least = min(min(w.x, w.y), min(w.z, w.w));
    return most - least <= kSame * most ? f : step(0.5, f);
}

float w_at(vec2 x)
{
    vec2 f;
    ivec2 a = cell(inside(x), f);
    // At the corner shared by the four pixels, half a pixel away from where rounding would choose others.
    vec4 w = textureGather(picture, (vec2(a) + 1.0) / vec2(textureSize(picture, 0)), 3).wzxy;
    f = weights(f, w);
    return mix(mix(w.x, w.y, f.x), mix(w.z, w.w, f.x), f.y);
}

/// @param found  false: x lies beside a hole, and only the pixels' nearest is of the surface that fills it
vec3 color_at(vec2 x, bool found)
{
    vec2 f;
    ivec2 a = cell(inside(x), f), b = min(a + 1, textureSize(picture, 0) - 1);
    vec4 p = texelFetch(picture, a, 0), q = texelFetch(picture, ivec2(b.x, a.y), 0),
         r = texelFetch(picture, ivec2(a.x, b.y), 0), s = texelFetch(picture, b, 0);
    f = found ? f : weights(f, vec4(p.a, q.a, r.a, s.a));
    return f == vec2(0.0) ? p.rgb : mix(mix(p, q, f.x), mix(r, s, f.x), f.y).rgb;
}

/// Least and greatest w that can lie at r after a shift.
vec2 range_at(vec2 r, float shift)
{
    vec2 range = texelFetch(around, ivec2(inside(r)) / TILE, 0).rg;
    return shift * nearest <= float(TILE) ? range : vec2(0.0, nearest);
}

/// The place that B shows at a pixel which would show r if all were far away. One loop with one look-up, because
/// pixels that are drawn together take as many as the slowest of them.
/// @param c  shift, px per w    @param found  false: a hole, filled by what is beside it
vec2 search(vec2 r, vec2 c, out bool found)
{
    const int kFar = 0, kNear = 1, kHole = 2, kBeside = 3, kDone = 4;
    float shift = length(c), far_w = 0.0, limit = 0.0;
    vec2 range = range_at(r, shift), hole = r;
    float near = range.y, w = shift * (range.y - range.x) < kConverged ? 0.5 * (range.x + range.y) : 0.0;
    bool far_good = false;
    int state = kFar, n = 0;
    vec2 x = r + c * w;
    found = true;
    while (state != kDone) {
        float there = w_at(x);
        ++n;
        if (state == kFar || state == kNear) {
            float residual = shift * abs(there - w);
            bool good = residual < kConverged, ends = residual <= kClose || n > kSteps;
            w = there;
            if (ends && state == kFar) {
                // No surface is near enough to be shifted by more than the tolerance.
                state = good && shift * (near - w) < kConverged ? kDone : kNear;
                far_w = w;
                far_good = good;
                w = state == kNear ? near : w;
                n = 0;
            } else if (ends) {
                state = good || far_good ? kDone : kHole;
                w = good && !(far_good && far_w >= w) ? w : far_good ? far_w : min(far_w, w);
                n = 0;
            }
            x = r + c * w;
        } else if (state == kHole) { // the first place along the shift that is not nearer
            found = false;
            w = min(w, there);
            limit = w * (1.0 + kSame) + 1e-6;
            hole = r + c * w;
            state = kBeside;
            n = 0;
            x = hole + c * (max(nearest - w, 0.0) / float(kWalk));
        } else if (there <= limit || n == 2 * kWalk) {
            x = there <= limit ? x : hole;
            state = kDone;
        } else {
            float way = float(n / 2 + 1) / float(kWalk);
            x = hole + c * (max(nearest - w, 0.0) * ((n & 1) == 0 ? way : -way));
        }
    }
    return x;
}

/// The place that B shows at its pixel p.
/// @param found  as color_at()    @param depth_in_a  over the depth in B, of what is far away
vec2 place_of(vec2 p, out bool found, out float depth_in_a)
{
    vec3 far = a_from_b * vec3(p, 1.0);
    depth_in_a = far.z;
    // Behind A: the edge on that side.
    vec2 r = far.xy / max(far.z, 1e-6);
    found = true;
    return SEARCHES == 1 ? search(r, b_in_a.xy - r * b_in_a.z, found) : r;
}
