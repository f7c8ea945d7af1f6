// The light of a surface, found in the newest pictures of light: the rule of gi/surfaces/kept_light.h. Where the newest of
// all views show nothing similar, older ones are asked, then the pixels around in the newest, then cells of space; what none of them know has the mean light of the last pictures.

layout(binding = 2) uniform usampler2DArray lights; // LightTexel of gi/surfaces/light_picture.h
layout(binding = 3) uniform usampler2DArray slopes; // LightSlope

const int kPictures = 24;
uniform int pictures, newest_pictures;       // the newest come first
uniform int light_layers[kPictures], light_mirrors[kPictures]; // mirrors: in which they show what they do; 0 = none
uniform vec3 light_eye[kPictures];           // positions of their cameras
uniform mat3 texel_from_world[kPictures];    // to places in them, times the depth
uniform ivec2 light_size[kPictures];         // of each picture, texels
uniform vec2 texel_at[kPictures];            // where rays pass texels
uniform float lacks_punctual[kPictures];     // 1 = their light is without that of punctual lights
uniform vec3 mean_light, head;               // head: where the light of its views was found
uniform float mean_lacks_punctual;

const float kEdge = 0.05; // trust in outermost texels, which are noisier, as they were seen for the shortest time
const float kAlike = 0.3, kUnlike = 0.01, kLeast = 1e-4, kOfDepth = 0.005; // as KeptLight

layout(binding = 14) uniform usampler2D cells; // LightCellTable of gi/surfaces/light_cells.h: keys and light

const int kLevels = 6, kBucketsWidth = 256, kBuckets = 65536;
uniform float narrowest_cell;   // m; 0 = there are none
uniform float cells_lack_punctual;

uint cell_key(ivec3 cell, int level, int side)
{
    uvec3 c = uvec3(cell);
    uint h = c.x * 73856093u;
    h = (h ^ h >> 15) * 0x2c1b3c6du + c.y * 19349663u;
    h = (h ^ h >> 13) * 0x297a2d39u + c.z * 83492791u;
    h = (h ^ h >> 15) * 0x2c1b3c6du + uint(6 * level + side) * 2654435761u;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return (h ^ h >> 16) | 1u;
}

// Between the cells around a place, of the narrowest level that has any; a: 0 = none has. Hidden ones may be behind a wall:
// they count where the place's own narrow cell is known and none is around that is not hidden.
vec4 find_in_cells(vec3 at, vec3 n, float distance)
{
    vec3 size = abs(n);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2, side = 2 * axis + (n[axis] < 0.0 ? 1 : 0);
    vec4 sum = vec4(0.0), behind = vec4(0.0);
    bool is_behind = false;
    int narrowest = narrowest_cell > 0.0 ? clamp(int(floor(log2(0.04 * distance / narrowest_cell))), 0, kLevels - 1) : kLevels;
    for (int level = narrowest; level < kLevels && sum.a < 0.05 && !is_behind; ++level) {
        vec3 u = at / (narrowest_cell * exp2(float(level))) - 0.5, low = floor(u), f = u - low;
        sum = behind = vec4(0.0);
        for (int j = 0; j < 8; ++j) {
            ivec3 step = ivec3(j & 1, j >> 1 & 1, j >> 2);
            vec3 w = mix(1.0 - f, f, vec3(step));
            uint key = cell_key(ivec3(low) + step, level, side);
            uvec4 bucket = uvec4(0u);
            for (int b = 0; b < 3; ++b) { // those that do not fit are in the next ones
                int k = int((key >> 1) + uint(b)) & kBuckets - 1;
                bucket = texelFetch(cells, ivec2(k % kBucketsWidth, k / kBucketsWidth), 0);
                if ((bucket.x | 1u) == key || (bucket.z | 1u) == key || bucket.z == 0u) break;
            }
            bool first = (bucket.x | 1u) == key, there = first || (bucket.z | 1u) == key;
            vec4 found = there ? w.x * w.y * w.z * vec4(unpack_light(first ? bucket.y : bucket.w), 1.0) : vec4(0.0);
            bool hidden = ((first ? bucket.x : bucket.z) & 1u) == 0u;
            sum += hidden ? vec4(0.0) : found;
            behind += hidden ? found : vec4(0.0);
            is_behind = is_behind || (hidden && found.a >= 0.125 && level < narrowest + 2);
        }
    }
    return sum.a < 0.05 && is_behind ? behind : sum;
}

struct FoundLight {
    vec3 light;
    uvec2 bent;  // LightSlope: the normal for which it is, and how it changes with the normal; its last two bits are LightSource
    float lacks; // the share that lacks the light of punctual lights
};

const uint kOfCells = 1u << 30, kOfNothing = 2u << 30; // LightSource of viewer/devices/gl/surface_renderer.h
const uint kNoSlope = 512u | 512u << 10 | 512u << 20;

// By how much light for one normal differs from that for another.
float turned(uint slope, vec3 from, vec3 to)
{
    const float kLeastTurned = 0.2, kMostTurned = 4.0;
    return clamp(1.0 + dot((vec3(uvec3(slope) >> uvec3(0u, 10u, 20u) & 1023u) - 512.0) / 64.0, to - from), kLeastTurned, kMostTurned);
}

vec3 turned_to(FoundLight found, vec3 n) { return turned(found.bent.y, unpack_normal(found.bent.x), n) * found.light; }

// What pictures show that is like a surface.
struct Likes {
    vec3 sum, weights, facings, best_facing;
    float best, lacks, counted;
    ivec3 nearest;
    int shown_in; // the first of the newest pictures in which the place lies
};

const Likes kNothingAlike = Likes(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, ivec3(0), -1);

// ring: 0 = the four texels around the place, 1 to 3 = corners and sides of the ring around these
void ask(inout Likes s, int picture, int ring, vec3 at, vec3 n)
{
    ivec2 size = light_size[picture];
    vec3 from = at - light_eye[picture], h = texel_from_world[picture] * from;
    vec2 u = h.xy / max(h.z, 1e-9) - texel_at[picture];
    bool inside = picture < pictures && h.z > 0.0 && all(greaterThan(u, vec2(-1.0))) && all(lessThan(u, vec2(size))) && (ring == 0 || s.shown_in >= 0);
    s.shown_in = inside && s.shown_in < 0 && picture < newest_pictures ? picture : s.shown_in;
    float trust = all(greaterThan(u, vec2(0.5))) && all(lessThan(u, vec2(size) - 1.5)) ? 1.0 : kEdge;
    vec2 whole = floor(u), f = u - whole;
    int taps = inside ? 4 : 0;
    for (int j = 0; j < taps; ++j) {
        ivec2 step = ivec2(j & 1, j >> 1);
        float w = (step.x == 0 ? 1.0 - f.x : f.x) * (step.y == 0 ? 1.0 - f.y : f.y) + 0.02;
        if (ring > 0) {
            ivec2 far = 3 * step - 1;
            step = ivec2(ring == 2 ? step.x : far.x, ring == 3 ? step.y : far.y);
            w = 0.25;
        }
        ivec2 p = ivec2(whole) + step;
        bool there = all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, size));
        ivec3 texel = ivec3(clamp(p, ivec2(0), size - 1), light_layers[picture]);
        uvec4 t = texelFetch(lights, texel, 0);
        vec3 facing = unpack_normal(t.x);
        float depth = (t.w >> 3 & 3u) == uint(light_mirrors[picture]) ? uintBitsToFloat(t.w & ~31u) : 0.0, off = (dot(facing, from) - uintBitsToFloat(t.y)) / (kOfDepth * max(depth, 1e-30));
        float cosine = max(0.0, dot(facing, n)), c2 = cosine * cosine, c4 = c2 * c2, like = c4 * c4 / (1.0 + off * off * off * off);
        w = there && depth > 0.0 ? w * trust * (like + kLeast) : 0.0;
        like *= trust;
        vec3 by_channel = w * vec3(1u - (uvec3(t.w) >> uvec3(0u, 1u, 2u) & 1u));
        s.sum += by_channel * unpack_light(t.z);
        s.weights += by_channel;
        s.lacks += w * lacks_punctual[picture];
        s.counted += w;
        s.facings += w * facing;
        s.nearest = w > 0.0 && like > s.best ? texel : s.nearest;
        s.best_facing = w > 0.0 && like > s.best ? facing : s.best_facing;
        s.best = max(s.best, w > 0.0 ? like : 0.0);
    }
}

// In all pictures; those of each eye in the same order.
Likes ask_pictures(vec3 at, vec3 n)
{
    Likes s = kNothingAlike;
    for (int k = 0; k < pictures && s.best <= kAlike; ++k) ask(s, k, 0, at, n);
    bool around = s.best <= kAlike;
    for (int ring = 1; ring < 4 && around; ++ring) ask(s, max(s.shown_in, 0), ring, at, n);
    return s;
}

FoundLight light_of(Likes s, vec3 n)
{
    FoundLight found = FoundLight(mean_light, uvec2(pack_normal(n), kNoSlope), mean_lacks_punctual);
    if (s.best >= kUnlike || (s.shown_in >= 0 && s.counted > 0.0)) {
        found.light = mix(mean_light, s.sum / max(s.weights, vec3(1e-20)), greaterThan(s.weights, vec3(0.0)));
        found.lacks = s.lacks / s.counted;
        uvec2 slope = texelFetch(slopes, s.nearest, 0).xy;
        if (s.best >= kUnlike && slope.y != 0u) // 0 = not known, as of full pictures
            found.bent = uvec2(pack_normal(unpack_normal(slope.x) + s.facings / s.counted - s.best_facing), slope.y);
    }
    found.bent.y |= s.best < kUnlike ? kOfNothing : 0u;
    return found;
}

// a: 0 = cells know nothing
FoundLight light_of(vec4 known, vec3 n)
{
    return FoundLight(known.rgb / known.a, uvec2(pack_normal(n), kNoSlope | kOfCells), cells_lack_punctual);
}

FoundLight find_light(vec3 at, vec3 n)
{
    FoundLight found = light_of(ask_pictures(at, n), n);
    vec4 known = vec4(0.0);
    for (int once = 0; once < 1 && (found.bent.y & kOfNothing) != 0u; ++once) known = find_in_cells(at, n, distance(at, head));
    if (known.a > 0.0) found = light_of(known, n);
    return found;
}
