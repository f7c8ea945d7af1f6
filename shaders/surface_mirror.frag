// Flat mirrors show what was drawn for them; other mirrors and panes, what they did in the last picture, at the depth of its
// image (viewer/devices/gl/surface_renderer.h).

#if PLANAR
layout(binding = 0) uniform sampler2D image;
layout(binding = 15) uniform usampler2D found; // for it, of surface_found.frag

uniform vec3 eye;
uniform vec4 mirror_plane; // normal, and distance from the world's origin
uniform float mirror_tolerance;
#endif

out vec4 color; // a: 2 + LightSource of what is seen, viewer/devices/gl/surface_renderer.h

void main()
{
    Shaded s = shade();
    if (!s.is_mirror) discard;
#if PLANAR
    if (abs(dot(mirror_plane.xyz, eye + from_eye) - mirror_plane.w) > mirror_tolerance) discard;
    uvec4 f = texelFetch(found, ivec2(gl_FragCoord.xy) >> 1, 0);
    float source = (f.w & ~3u) == 0u ? 3.0 : float(f.z >> 30);
    color = vec4(s.emitted + s.reflected * texelFetch(image, ivec2(gl_FragCoord.xy), 0).rgb, 2.0 + source);
#else
    bool found;
    float depth_in_a;
    vec2 x = place_of(gl_FragCoord.xy, found, depth_in_a);
    color = vec4(color_at(x, found), 5.0);
#endif
}
