// See viewer/devices/gl/wall_pass.h. Places are 0..1 from the lower left; textures have their top row first.

layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D weights;

uniform vec4 overlap; // left, right, bottom, top
uniform float power;
uniform vec3 gain, gamma;

in vec2 place;
in float vertex_weight;
out vec4 color;

float side(float at, float width)
{
    if (width <= 0.0 || at >= width) return 1.0;
    float t = max(at / width, 0.0);
    return t < 0.5 ? 0.5 * pow(2.0 * t, power) : 1.0 - 0.5 * pow(2.0 * (1.0 - t), power);
}

void main()
{
    vec3 v = bilinear(picture, place).rgb;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) v = vec3(0.0);
    float weight = vertex_weight * bilinear(weights, place).r * side(place.x, overlap.x) *
                   side(1.0 - place.x, overlap.y) * side(place.y, overlap.z) * side(1.0 - place.y, overlap.w);
    vec3 factor = weight * gain;
    // pow(1) need not be 1, pow(0) is not defined everywhere.
    vec3 f = mix(pow(max(factor, vec3(1e-12)), 1.0 / gamma), vec3(1.0), equal(factor, vec3(1.0)));
    f = mix(f, vec3(0.0), equal(factor, vec3(0.0)));
    color = vec4(to_bytes(clamp(v * f, 0.0, 1.0)), 1.0);
}
