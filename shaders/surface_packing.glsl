// A surface in four words: normal (octahedral), albedo (square roots of 11, 11 and 10 bits), gloss (11 bits of roughness, 8
// of metallic, 4 of the coat's reflectance, 8 of transmission or the phong model), and emission (square roots of 8 bits each and
// an exponent). One that has moved since its light was found: a bit, 7, 4 and 4 bits of gloss, and instead of the rest the place
// then in the box of all such places, 16 bits each.

uint pack_normal(vec3 n)
{
    vec2 o = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) o = (1.0 - abs(o.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(o, vec2(0.0)));
    return packSnorm2x16(o);
}

vec3 unpack_normal(uint bits)
{
    vec2 o = unpackSnorm2x16(bits);
    vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
    float fold = max(-n.z, 0.0);
    n.xy -= mix(vec2(-fold), vec2(fold), greaterThanEqual(n.xy, vec2(0.0)));
    return n * inversesqrt(dot(n, n));
}

vec3 unpack_light(uint bits) // GL_RGB9_E5
{
    vec3 m = vec3(bits & 511u, bits >> 9 & 511u, bits >> 18 & 511u);
    return m * uintBitsToFloat((bits >> 27) + 127u - 24u << 23);
}

uint pack_light(vec3 light)
{
    float most = min(max(max(light.r, light.g), light.b), 65000.0) * (512.0 / 511.0); // rounding adds no bit
    uint power = uint(clamp(int(floatBitsToUint(most) >> 23) - 111, 0, 31));
    uvec3 m = min(uvec3(max(light, vec3(0.0)) * uintBitsToFloat(127u + 24u - power << 23) + 0.5), uvec3(511u));
    return m.r | m.g << 9 | m.b << 18 | power << 27;
}

uint pack_albedo(vec3 albedo)
{
    uvec3 a = uvec3(sqrt(clamp(albedo, 0.0, 1.0)) * vec3(2047.0, 2047.0, 1023.0) + 0.5);
    return a.r | a.g << 11 | a.b << 22;
}

const float kMostCoat = 0.15;

// gloss: roughness, metallic, reflectance of the coat, transmission; or roughness, reflectance of the lobe, 0, -1: phong
uint pack_gloss(vec4 gloss)
{
    uvec4 g = uvec4(clamp(gloss / vec4(1.0, 1.0, kMostCoat, 1.0), 0.0, 1.0) * vec4(2047.0, 255.0, 15.0, 127.0) + 0.5);
    return (gloss.w < 0.0 ? 1u << 30 : 0u) | g.w << 23 | g.x << 12 | g.y << 4 | g.z;
}

uint pack_gloss_of_moved(vec4 gloss)
{
    uvec3 g = uvec3(clamp(gloss.xyz / vec3(1.0, 1.0, kMostCoat), 0.0, 1.0) * vec3(127.0, 15.0, 15.0) + 0.5);
    return 1u << 31 | g.x << 24 | g.y << 20 | g.z << 16;
}

bool has_moved(uvec4 described) { return described.z >> 31 != 0u; }

vec4 gloss_of(uvec4 described)
{
    uint z = described.z;
    vec4 moved = vec4(uvec3(z >> 24, z >> 20, z >> 16) & uvec3(127u, 15u, 15u), 0.0) / vec4(127.0, 15.0, 15.0 / kMostCoat, 1.0);
    vec4 own = vec4(uvec4(z >> 12, z >> 4, z, z >> 23) & uvec4(2047u, 255u, 15u, 127u)) / vec4(2047.0, 255.0, 15.0 / kMostCoat, 127.0);
    own.w = (z >> 30 & 1u) != 0u ? -1.0 : own.w;
    return has_moved(described) ? moved : own;
}

uvec4 describe_moved(vec3 albedo, vec3 n, vec4 gloss, vec3 in_box)
{
    uvec3 p = uvec3(clamp(in_box, 0.0, 1.0) * 65535.0 + 0.5);
    return uvec4(pack_normal(n), pack_albedo(albedo), pack_gloss_of_moved(gloss) | p.x, p.y << 16 | p.z);
}

vec3 place_in_box(uvec4 described)
{
    return vec3(described.z & 0xffffu, described.w >> 16, described.w & 0xffffu) / 65535.0;
}

uvec4 describe(vec3 albedo, vec3 n, vec4 gloss, vec3 emitted)
{
    uint e = 0u;
#if EMITS
    float most = max(max(emitted.r, emitted.g), emitted.b);
    if (most > 1e-30) {
        int power = int(ceil(log2(most * (256.0 / 255.0))));
        uvec3 m = uvec3(sqrt(emitted * exp2(float(-power))) * 255.0 + 0.5);
        e = m.r | m.g << 8 | m.b << 16 | uint(power + 128) << 24;
    }
#endif
    return uvec4(pack_normal(n), pack_albedo(albedo), pack_gloss(gloss), e);
}

vec3 albedo_of(uvec4 described)
{
    vec3 root = vec3(described.y & 2047u, described.y >> 11 & 2047u, described.y >> 22) / vec3(2047.0, 2047.0, 1023.0);
    return root * root;
}

vec3 emission_of(uvec4 described)
{
    if (has_moved(described)) return vec3(0.0);
    vec3 m = vec3(described.w & 255u, described.w >> 8 & 255u, described.w >> 16 & 255u) / 255.0;
    return m * m * uintBitsToFloat(clamp(described.w >> 24, 2u, 254u) - 1u << 23);
}
