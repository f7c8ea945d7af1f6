// See viewer/devices/gl/fade_pass.h. The pictures' top row is their first.

layout(binding = 0) uniform sampler2D before; // encoded
layout(binding = 1) uniform sampler2D after;

uniform ivec2 corner; // of the target
uniform bool top_last;
uniform float share; // of the second

out vec4 color;

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy) - corner;
    if (top_last) p.y = textureSize(after, 0).y - 1 - p.y;
    color = mix(texelFetch(before, p, 0), texelFetch(after, p, 0), share);
}
