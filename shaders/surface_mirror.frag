// Flat mirrors show what was drawn for them; other mirrors and panes, what they did in the last picture, at the depth of its
// image (viewer/devices/gl/surface_renderer.h).

#if PLANAR
layout(binding = 0) uniform sampler2D image;

uniform vec3 eye;
uniform vec4 mirror_plane; // normal, and distance from the world's origin
uniform float mirror_tolerance;
#endif

out vec4 color;

void main()
{
    Shaded s = shade();
    if (!s.is_mirror) discard;
#if PLANAR
    if (abs(dot(mirror_plane.xyz, eye + from_eye) - mirror_plane.w) > mirror_tolerance) discard;
    color = vec4(s.emitted + s.reflected * texelFetch(image, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
#else
    bool found;
    float depth_in_a;
    vec2 x = place_of(gl_FragCoord.xy, found, depth_in_a);
    color = vec4(color_at(x, found), 1.0);
#endif
}
