// A material, as Material and make_bsdf of gi/scene. MAPS: bits of the maps that it has; ALPHAS: its vertices have alphas.

layout(std140, binding = 0) uniform Material
{
    vec4 base_color;     // a: alpha
    vec4 emission;       // a: 1 = from both sides
    vec4 specular_color; // a: specular
    vec4 phong_specular; // a: 1 = the phong model
    vec4 factors;        // metallic, roughness, transmission, scale of the normal map
    vec4 more;           // reflectance by the index of refraction, least alpha of a mask, roughness of the phong lobe
    vec4 rows[7];        // of the transform of texture coordinates
    vec4 places[7];      // its offset, and the set of coordinates
};

layout(binding = 5) uniform sampler2D maps[7];

#if MAPS
in vec2 uv0, uv1;

#define BASE_COLOR 0
#define METALLIC_ROUGHNESS 1
#define NORMAL 2
#define EMISSIVE 3
#define SPECULAR 4
#define SPECULAR_COLOR 5
#define TRANSMISSION 6
#define MAP(map) texture(maps[map], at_map(map))

vec2 at_map(int map)
{
    vec2 uv = places[map].z == 0.0 ? uv0 : uv1;
    return vec2(dot(rows[map].xy, uv), dot(rows[map].zw, uv)) + places[map].xy;
}
#endif

#if ALPHAS
in float vertex_alpha;
#endif

float coverage()
{
    float alpha = base_color.a;
#if ALPHAS
    alpha *= vertex_alpha;
#endif
#if MAPS & 1
    alpha *= MAP(BASE_COLOR).a;
#endif
    return alpha;
}
