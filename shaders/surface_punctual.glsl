// The light of punctual lights, through shadow maps (viewer/devices/gl/shadow_maps.h): sample_punctual and evaluate of
// gi/scene/shading.

struct PunctualLight {
    vec4 position;  // w: 1 = directional
    vec4 direction; // w: 1 = a spot
    vec4 intensity; // w: range, m; 0 = unlimited
    vec4 cone;      // cosines of the inner and outer angle; width of a texel of the second map
    vec4 map;       // first layer, number, width of a texel (at a distance of 1 m, if in perspective)
};

layout(std140, binding = 1) uniform Punctual
{
    PunctualLight punctual[4];
    mat4 map_from_world[24]; // six places for each
};

layout(binding = 1) uniform sampler2D facets; // tables of gi/scene/shading/ggx_albedo.h, see facets_texture
layout(binding = 13) uniform sampler2DArrayShadow shadows;

float schlick(float f0, float f90, float cosine)
{
    float m = clamp(1.0 - cosine, 0.0, 1.0), m2 = m * m;
    return f0 + (f90 - f0) * m2 * m2 * m;
}

// The node at x from 0 to 1 of a table with 24.
float node(float x)
{
    return 23.0 * clamp(x, 0.0, 1.0) + 0.5;
}

// facets_albedo of gi/scene/shading: parts of f0 and f90
vec2 facets_albedo(float cosine, float roughness)
{
    float half_alpha = 0.5 * roughness * roughness, grazing = schlick(0.0, 1.0, cosine), y = node(roughness) / 24.0;
    if (2.0 * half_alpha >= SMOOTH_ALPHA) {
        float x = cosine * (1.0 + half_alpha) / (cosine + half_alpha + 1e-12);
        float sum = textureLod(facets, vec2(node(x) / 25.0, y), 0.0).r;
        grazing = sum * textureLod(facets, vec2(node(sqrt(cosine)) / 25.0, y), 0.0).g;
        return vec2(sum - grazing, grazing);
    }
    return vec2(1.0 - grazing, grazing);
}

// Its mean over the hemisphere, weighted by the cosine.
vec2 facets_mean(float roughness)
{
    vec2 mean = textureLod(facets, vec2(24.5 / 25.0, node(roughness) / 24.0), 0.0).rg;
    return roughness * roughness < SMOOTH_ALPHA ? vec2(20.0, 1.0) / 21.0 : vec2(mean.x - mean.y, mean.y);
}

// Of light k, a constant, as software drivers read at other places for each pixel by itself. SHADOW_MAPS is the number
// of its maps, 0 if any is possible. 1 = lit
float reached(const int k, PunctualLight light, vec3 at, vec3 n)
{
    const float kOff = 1.5; // texels
    int face = 0;
    vec4 p = vec4(0.0);
#if SHADOW_MAPS != 6
    p = map_from_world[6 * k] * vec4(at, 1.0);
    p = map_from_world[6 * k] * vec4(at + kOff * light.map.z * max(p.w, 0.0) * n, 1.0);
#endif
#if SHADOW_MAPS == 0 || SHADOW_MAPS == 2
    if (light.map.y == 2.0 && any(greaterThan(abs(p.xy), vec2(1.0)))) {
        face = 1;
        p = map_from_world[6 * k + 1] * vec4(at + kOff * light.cone.z * n, 1.0);
    }
#endif
#if SHADOW_MAPS == 0 || SHADOW_MAPS == 6
    if (light.map.y == 6.0) {
        vec3 away = at - light.position.xyz, size = abs(away);
        bool x = size.x >= size.y && size.x >= size.z, y = !x && size.y >= size.z;
        face = x ? (away.x < 0.0 ? 1 : 0) : y ? (away.y < 0.0 ? 3 : 2) : (away.z < 0.0 ? 5 : 4);
        mat4 map = map_from_world[6 * k + face];
        p = map * vec4(at, 1.0);
        p = map * vec4(at + kOff * light.map.z * max(p.w, 0.0) * n, 1.0);
    }
#endif
    vec3 q = p.xyz / max(p.w, 1e-6);
    return any(greaterThan(abs(q.xy), vec2(1.0))) || q.z >= 1.0 ? 1.0
                                                                : texture(shadows, vec4(0.5 * q.xy + 0.5, light.map.x + float(face), q.z));
}

// Radiance towards `to_viewer` by light k, a constant.
vec3 punctual_of(const int k, vec3 at, vec3 n, vec3 to_viewer, vec3 albedo, vec4 gloss)
{
    const float kPi = 3.14159265359;
    PunctualLight light = punctual[k];
    vec3 way = light.position.xyz - at, wi = -light.direction.xyz, sum = vec3(0.0);
    float factor = 1.0;
    if (light.position.w == 0.0) {
        float squared = max(dot(way, way), 1e-12), reach = light.intensity.w;
        wi = way * inversesqrt(squared);
        float window = 1.0 - squared * squared / max(reach * reach * reach * reach, 1e-30);
        factor = (reach > 0.0 ? clamp(window, 0.0, 1.0) : 1.0) / squared;
        float cone = clamp((-dot(wi, light.direction.xyz) - light.cone.y) / max(light.cone.x - light.cone.y, 1e-3), 0.0, 1.0);
        factor *= light.direction.w > 0.0 ? cone * cone : 1.0;
    }
    float cos_i = dot(n, wi);
    factor *= max(cos_i, 0.0);
    if (factor > 0.0) {
        factor *= reached(k, light, at, n);
        bool phong = gloss.w < 0.0;
        float metallic = phong ? 0.0 : gloss.y, opaque = (1.0 - metallic) * (1.0 - max(gloss.w, 0.0)), coat = gloss.z > 0.0 ? 1.0 : 0.0;
        vec3 base = max(albedo - (phong ? gloss.y : opaque * gloss.z), vec3(0.0)), f0 = opaque * gloss.z + metallic * base;
        float f90 = opaque * coat + metallic, alpha = gloss.x * gloss.x, a2 = alpha * alpha, exponent = 2.0 / max(a2, 1e-12) - 2.0;
        float cos_o = max(dot(n, to_viewer), 1e-3);
        vec2 once_o = facets_albedo(cos_o, gloss.x), once_i = facets_albedo(cos_i, gloss.x), once = facets_mean(gloss.x);
        vec2 of_coat = vec2(gloss.z, coat);
        float mean = 1.0 - dot(once, of_coat), rest = 1.0 - once.x - once.y;
        float passes = mean > 0.0 ? (1.0 - dot(once_o, of_coat)) * (1.0 - dot(once_i, of_coat)) / mean : 0.0;
        vec3 f_mean = base + (1.0 - base) / 21.0, again = vec3(0.0);
        if (rest >= 1e-4 && alpha >= SMOOTH_ALPHA)
            again = metallic * f_mean * f_mean * (1.0 - rest) / ((1.0 - f_mean * rest) * rest);
        vec3 h = normalize(to_viewer + wi), across = cross(n, h);
        float cos_h = dot(n, h), t = dot(across, across) / max(a2, 1e-12) + cos_h * cos_h, grazing = schlick(0.0, 1.0, dot(to_viewer, h));
        float visible = 0.5 / (cos_i * sqrt(a2 + (1.0 - a2) * cos_o * cos_o) + cos_o * sqrt(a2 + (1.0 - a2) * cos_i * cos_i));
        float lobe = alpha < SMOOTH_ALPHA ? 0.0 : visible / (kPi * a2 * t * t);
        vec3 f = (opaque * passes * base + (1.0 - once_o.x - once_o.y) * (1.0 - once_i.x - once_i.y) * again) / kPi;
        f += lobe * (f0 + (f90 - f0) * grazing);
        if (phong)
            f = base / kPi + gloss.y * (exponent + 1.0) * (0.5 / kPi) * pow(max(dot(reflect(-to_viewer, n), wi), 1e-6), exponent);
        sum = factor * light.intensity.rgb * f;
    }
    return sum;
}

#if PUNCTUAL
// Radiance towards `to_viewer` by all PUNCTUAL lights. gloss: of surface_packing.glsl
vec3 punctual_light(vec3 at, vec3 n, vec3 to_viewer, vec3 albedo, vec4 gloss)
{
    vec3 sum = punctual_of(0, at, n, to_viewer, albedo, gloss);
#if PUNCTUAL > 1
    sum += punctual_of(1, at, n, to_viewer, albedo, gloss);
#endif
#if PUNCTUAL > 2
    sum += punctual_of(2, at, n, to_viewer, albedo, gloss);
#endif
#if PUNCTUAL > 3
    sum += punctual_of(3, at, n, to_viewer, albedo, gloss);
#endif
    return sum;
}
#endif
