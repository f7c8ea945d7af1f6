// See viewer/devices/gl/wall_pass.h. Places are 0..1 from the lower left; textures have their top row first.

layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D weights;
layout(binding = 2) uniform sampler2D black_level;
layout(binding = 3) uniform sampler2D positions; // of pixels in the picture, and 1; (0, 0, 0) = none

uniform vec4 overlap; // left, right, bottom, top
uniform float power;
uniform float has_positions, has_black_level; // 1 or 0
uniform vec3 gain, gamma;

in vec2 place;
in vec2 at;
in float vertex_weight;
out vec4 color;

float side(float at_side, float width)
{
    if (width <= 0.0 || at_side >= width) return 1.0;
    float t = max(at_side / width, 0.0);
    return t < 0.5 ? 0.5 * pow(2.0 * t, power) : 1.0 - 0.5 * pow(2.0 * (1.0 - t), power);
}

// pow(1) need not be 1, pow(0) is not defined everywhere.
vec3 powers(vec3 x, vec3 exponent)
{
    vec3 p = mix(pow(max(x, vec3(1e-12)), exponent), vec3(1.0), equal(x, vec3(1.0)));
    return mix(p, vec3(0.0), equal(x, vec3(0.0)));
}

void main()
{
    vec2 from = place;
    if (has_positions > 0.5) {
        vec3 found = bilinear(positions, at).xyz;
        if (found.z < 0.5) discard;
        from = found.xy / found.z;
    }
    vec3 v = bilinear(picture, from).rgb;
    if (any(lessThan(from, vec2(0.0))) || any(greaterThan(from, vec2(1.0)))) v = vec3(0.0);
    float fade = side(from.x, overlap.x) * side(1.0 - from.x, overlap.y) * side(from.y, overlap.z) *
                 side(1.0 - from.y, overlap.w);
    vec3 factor = vertex_weight * fade * bilinear(weights, at).rgb * gain;
    vec3 encoded = v * powers(factor, 1.0 / gamma);
    if (has_black_level > 0.5)
        encoded = powers(mix(powers(clamp(encoded, 0.0, 1.0), gamma), vec3(1.0), bilinear(black_level, at).rgb), 1.0 / gamma);
    color = vec4(to_bytes(clamp(encoded, 0.0, 1.0)), 1.0);
}
