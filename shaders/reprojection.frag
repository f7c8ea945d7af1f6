// See viewer/devices/gl/reprojection.h. All positions are pixels of picture A from its top left; w = 1 / depth. SEARCHES is a
// define, 0 where B stands where A stood.

layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D depth;

uniform mat3 a_from_b;
uniform vec3 b_in_a;
uniform float nearest; // greatest w in the picture

out vec4 color;

const int kSteps = 6;          // of each search
const float kClose = 0.05;     // px: no further step
const float kConverged = 0.5;  // px: taken as a solution
const float kSame = 0.1;       // relative difference of w within one surface
const int kWalk = 12;          // steps beside a hole
const float kSnap = 1.0 / 256; // px: as near to a pixel's middle as this is at it

vec2 inside(vec2 x) { return clamp(x, vec2(0.5), vec2(textureSize(picture, 0)) - 0.5); }

/// Pixel whose middle is left of and above x, and how far x is beyond it, 0 where it is hardly.
ivec2 cell(vec2 x, out vec2 f)
{
    vec2 u = x - 0.5, whole = floor(u + kSnap);
    f = u - whole;
    f = mix(f, vec2(0.0), lessThan(f, vec2(kSnap)));
    return ivec2(whole);
}

struct Corners {
    ivec2 a, b; // opposite pixels
    vec2 f;
    vec4 w;      // of (a), (b.x, a.y), (a.x, b.y), (b)
    bool smooth_; // all of one surface
};

Corners corners_at(vec2 x)
{
    Corners c;
    c.a = cell(x, c.f);
    c.b = min(c.a + 1, textureSize(picture, 0) - 1);
    c.w = vec4(0.0);
    c.smooth_ = true;
    if (SEARCHES == 1) {
        // At the corner that the four share, half a pixel from where others would be meant.
        vec4 d = textureGather(depth, (vec2(c.a) + 1.0) / vec2(textureSize(depth, 0))).wzxy;
        c.w = mix(vec4(0.0), 1.0 / d, greaterThan(d, vec4(0.0)));
        float most = max(max(c.w.x, c.w.y), max(c.w.z, c.w.w)), least = min(min(c.w.x, c.w.y), min(c.w.z, c.w.w));
        c.smooth_ = most - least <= kSame * most;
    }
    return c;
}

int nearest_corner(vec2 f) { return (f.x < 0.5 ? 0 : 1) + (f.y < 0.5 ? 0 : 2); }

float w_at(vec2 x)
{
    Corners c = corners_at(inside(x));
    if (!c.smooth_) return c.w[nearest_corner(c.f)];
    return mix(mix(c.w.x, c.w.y, c.f.x), mix(c.w.z, c.w.w, c.f.x), c.f.y);
}

vec3 color_at(vec2 x)
{
    Corners c = corners_at(inside(x));
    int n = nearest_corner(c.f);
    ivec2 near = ivec2((n & 1) == 0 ? c.a.x : c.b.x, (n & 2) == 0 ? c.a.y : c.b.y);
    if (!c.smooth_ || c.f == vec2(0.0)) return texelFetch(picture, near, 0).rgb;
    vec3 top = mix(texelFetch(picture, c.a, 0).rgb, texelFetch(picture, ivec2(c.b.x, c.a.y), 0).rgb, c.f.x);
    vec3 bottom = mix(texelFetch(picture, ivec2(c.a.x, c.b.y), 0).rgb, texelFetch(picture, c.b, 0).rgb, c.f.x);
    return mix(top, bottom, c.f.y);
}

struct Found {
    float w;        // of the last place looked at
    float residual; // px
};

/// @param needed whether the answer is wanted: the loop is not entered otherwise
Found search(vec2 r, vec2 c, float w, bool needed)
{
    float shift = length(c);
    Found found = Found(w, needed ? 1e30 : 0.0);
    for (int k = 0; k < kSteps && found.residual > kClose; ++k) {
        float there = w_at(r + c * found.w);
        found = Found(there, shift * abs(there - found.w));
    }
    return found;
}

/// The first place beside x along the shift that is not nearer than w.
vec2 beside(vec2 x, vec2 c, float w, bool good)
{
    if (good) return x;
    vec2 reach = c * max(nearest - w, 0.0);
    float limit = w * (1.0 + kSame) + 1e-6;
    for (int k = 1; k <= kWalk; ++k) {
        vec2 step = reach * (float(k) / float(kWalk));
        if (w_at(x + step) <= limit) return x + step;
        if (w_at(x - step) <= limit) return x - step;
    }
    return x;
}

void main()
{
    vec3 far = a_from_b * vec3(gl_FragCoord.xy, 1.0); // FragCoord: the target's top row is its first
    // Behind A: the edge on that side.
    vec2 r = far.xy / max(far.z, 1e-6);
    bool seen = far.z > 0.0;
    vec2 x = r;
    if (SEARCHES == 1) {
        vec2 c = b_in_a.xy - r * b_in_a.z;
        Found from_far = search(r, c, w_at(r), true);
        bool far_good = from_far.residual < kConverged;
        // Nothing in the picture is so much nearer that it would lie elsewhere.
        bool alone = far_good && length(c) * (nearest - from_far.w) < kConverged;
        Found from_near = search(r, c, alone ? from_far.w : nearest, !alone);
        bool near_good = from_near.residual < kConverged;
        seen = seen && (far_good || near_good);
        float w = near_good && (!far_good || from_near.w > from_far.w) ? from_near.w : from_far.w;
        if (!far_good && !near_good) {
            w = min(from_far.w, from_near.w);
            w = min(w, w_at(r + c * w));
        }
        x = beside(r + c * w, c, w, far_good || near_good);
    }
    vec2 size = vec2(textureSize(picture, 0));
    seen = seen && all(greaterThanEqual(x, vec2(0.0))) && all(lessThanEqual(x, size));
    color = vec4(color_at(x), seen ? 1.0 : 0.0);
}
