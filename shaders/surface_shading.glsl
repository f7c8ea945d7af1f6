// The surface of a fragment, as shading_point of gi/scene: what scatters there, and how it faces.

in vec3 from_eye, normal;
#if MAPS & 4
in vec4 tangent;
#endif
#if COLORS
in vec3 vertex_color;
#endif

struct Shaded {
    vec3 albedo, normal, emitted;
    vec4 gloss;     // of surface_packing.glsl
    bool is_mirror; // or a pane: what it shows is seen instead of it
#if MIRROR
    vec3 reflected; // share of the light from there
    bool is_pane;   // what is behind it is seen
#endif
};

vec3 face_viewer(vec3 n, vec3 to_viewer)
{
    const float kFacing = 1e-3;
    float cosine = dot(n, to_viewer);
    return cosine >= kFacing ? n : normalize(n + (2.0 * kFacing - cosine) * to_viewer);
}

#if MAPS & 4
// n: unit, of the front
vec3 mapped(vec3 n)
{
    vec4 given = tangent;
    if (given.xyz == vec3(0.0)) {
        vec2 uv = places[NORMAL].z == 0.0 ? uv0 : uv1, a = dFdx(uv), b = dFdy(uv);
        vec3 p = dFdx(from_eye), q = dFdy(from_eye);
        float determinant = a.x * b.y - a.y * b.x;
        given = vec4(determinant < 0.0 ? a.y * q - b.y * p : b.y * p - a.y * q, 0.0);
        vec3 down = determinant < 0.0 ? b.x * p - a.x * q : a.x * q - b.x * p; // dP/dv
        given.w = dot(cross(n, given.xyz), down) > 0.0 ? -1.0 : 1.0;
    }
    vec3 t = given.xyz - dot(given.xyz, n) * n;
    float size = length(t);
    if (!(size > 1e-6 * length(given.xyz))) return n;
    t /= size;
    vec3 bitangent = (given.w < 0.0 ? -1.0 : 1.0) * cross(n, t);
    vec3 texel = MAP(NORMAL).xyz * 2.0 - 1.0, m = factors.w * (texel.x * t + texel.y * bitangent) + texel.z * n;
    float l = length(m);
    return l > 1e-6 ? m / l : n;
}
#endif

Shaded shade()
{
    Shaded s;
    vec3 to_viewer = -normalize(from_eye), across = cross(dFdx(from_eye), dFdy(from_eye));
    bool front = !gl_FrontFacing; // the target's top row is its first
    vec3 facing = normalize(dot(across, to_viewer) < 0.0 ? -across : across), n = facing;
    float squared = dot(normal, normal);
    bool bent = squared > 1e-12;
    if (bent) n = normal * inversesqrt(squared);
#if MAPS & 4
    n = mapped(bent ? n : front ? facing : -facing);
    bent = true;
#endif
    if (bent) {
        if (dot(n, facing) < 0.0) n = -n;
        n = face_viewer(n, to_viewer);
    }

    vec3 base = base_color.rgb;
    float metallic = factors.x, roughness = factors.y, transmission = factors.z, specular = specular_color.a;
    vec3 tint = specular_color.rgb, emitted = emission.rgb;
#if MAPS & 1
    base *= MAP(BASE_COLOR).rgb;
#endif
#if COLORS
    base *= vertex_color;
#endif
#if MAPS & 2
    vec4 both = MAP(METALLIC_ROUGHNESS);
    roughness *= both.y;
    metallic *= both.z;
#endif
#if MAPS & 8
    emitted *= MAP(EMISSIVE).rgb;
#endif
#if MAPS & 16
    specular *= MAP(SPECULAR).a;
#endif
#if MAPS & 32
    tint *= MAP(SPECULAR_COLOR).rgb;
#endif
#if MAPS & 64
    transmission *= MAP(TRANSMISSION).r;
#endif
    bool phong = phong_specular.a > 0.0;
    float opaque = (1.0 - metallic) * (1.0 - transmission), clear = phong ? 0.0 : (1.0 - metallic) * transmission;
    vec3 f0 = opaque * min(more.x * tint, vec3(1.0)) * specular + metallic * base;
    s.albedo = phong ? base + phong_specular.rgb : opaque * base + f0 + clear * base;
    s.albedo = min(s.albedo, vec3(1.0));
    s.normal = n;
    s.gloss = phong ? vec4(more.z, dot(phong_specular.rgb, vec3(1.0 / 3.0)), 0.0, -1.0)
                    : vec4(roughness, metallic, dot(min(more.x * tint, vec3(1.0)), vec3(1.0 / 3.0)) * specular, transmission);
    s.emitted = front || emission.a > 0.0 ? emitted : vec3(0.0);
#if MIRROR
    const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
    float alpha = roughness * roughness, grazing = pow(clamp(1.0 - dot(n, to_viewer), 0.0, 1.0), 5.0);
    vec3 reflected = f0 + (vec3(opaque * specular + metallic) - f0) * grazing;
    float mirrors = alpha < SMOOTH_ALPHA && !phong ? dot(kLuminance, reflected) : 0.0, passes = clear * dot(kLuminance, base);
    s.reflected = reflected;
    s.is_mirror = max(mirrors, passes) > 0.5 * dot(kLuminance, s.albedo);
    s.is_pane = s.is_mirror && passes > mirrors;
#else
    s.is_mirror = false;
#endif
    return s;
}
