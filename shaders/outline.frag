// See viewer/devices/gl/outline_pass.h. The target's top row is its first, as the picture's.

layout(binding = 0) uniform sampler2D picture; // encoded; filtered

out vec4 color;

const float kLeast = 1.0 / 16.0, kOfBrightest = 1.0 / 8.0; // jumps of brightness that are smoothed
const float kFarthest = 8.0;                               // px along an edge

float bright(vec3 c) { return dot(c, vec3(0.299, 0.587, 0.114)); }

float bright_at(ivec2 p) { return bright(texelFetch(picture, clamp(p, ivec2(0), textureSize(picture, 0) - 1), 0).rgb); }

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 own = texelFetch(picture, p, 0).rgb;
    float m = bright(own);
    vec4 around = vec4(bright_at(p + ivec2(-1, -1)), bright_at(p + ivec2(1, -1)), bright_at(p + ivec2(-1, 1)), bright_at(p + ivec2(1, 1)));
    float low = min(m, min(min(around.x, around.y), min(around.z, around.w)));
    float high = max(m, max(max(around.x, around.y), max(around.z, around.w)));
    color = vec4(own, 1.0);
    // Another wall may go on at the picture's edges, and show the same there.
    bool inside = all(greaterThan(p, ivec2(0))) && all(lessThan(p, textureSize(picture, 0) - 1));
    for (int once = 0; once < 1 && inside && high - low > max(kLeast, kOfBrightest * high); ++once) {
        vec2 size = vec2(textureSize(picture, 0)), at = (vec2(p) + 0.5) / size;
        vec2 along = vec2(around.z + around.w - around.x - around.y, around.x + around.z - around.y - around.w);
        float blur = max(dot(around, vec4(1.0 / 32.0)), 1.0 / 128.0); // of edges that are nearly along an axis
        along = clamp(along / (min(abs(along.x), abs(along.y)) + blur), -kFarthest, kFarthest) / size;
        vec3 near = 0.5 * (texture(picture, at - along / 6.0).rgb + texture(picture, at + along / 6.0).rgb);
        vec3 far = 0.5 * near + 0.25 * (texture(picture, at - 0.5 * along).rgb + texture(picture, at + 0.5 * along).rgb);
        float b = bright(far);
        color.rgb = b < low || b > high ? near : far;
    }
}
