// The environment map behind all surfaces, as environment_radiance of gi/scene/shading.

layout(binding = 3) uniform sampler2D environment;

uniform mat3 map_from_pixel; // to directions in the map's own frame
uniform vec3 scale;

out vec4 color;

void main()
{
    const float kInvPi = 0.31830988618;
    vec3 d = map_from_pixel * vec3(gl_FragCoord.xy, 1.0);
    ivec2 size = textureSize(environment, 0);
    vec2 at = vec2(0.5 + atan(d.x, -d.z) * (0.5 * kInvPi), atan(length(d.xz), d.y) * kInvPi) * vec2(size) - 0.5;
    vec2 whole = floor(at), f = at - whole;
    ivec2 a = ivec2(whole), b = a + 1;
    ivec2 x = ivec2((a.x + size.x) % size.x, b.x % size.x), y = clamp(ivec2(a.y, b.y), ivec2(0), ivec2(size.y - 1));
    vec3 top = mix(texelFetch(environment, ivec2(x.x, y.x), 0).rgb, texelFetch(environment, ivec2(x.y, y.x), 0).rgb, f.x);
    vec3 bottom = mix(texelFetch(environment, ivec2(x.x, y.y), 0).rgb, texelFetch(environment, ivec2(x.y, y.y), 0).rgb, f.x);
    color = vec4(scale * mix(top, bottom, f.y), 1.0);
}
