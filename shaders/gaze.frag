// See viewer/devices/gl/gaze_pass.h. Pixels count from the top left of the target.

uniform ivec2 corner, target_size;
uniform bool top_last, hides_inside;
uniform vec2 centre;
uniform float radius, edge, grey;

out vec4 color;

void main()
{
    vec2 pixel = gl_FragCoord.xy - vec2(corner);
    if (top_last) pixel.y = float(target_size.y) - pixel.y;
    float outside = clamp((distance(pixel, centre) - radius) / max(edge, 1.0) + 0.5, 0.0, 1.0);
    color = vec4(vec3(grey), hides_inside ? 1.0 - outside : outside);
}
