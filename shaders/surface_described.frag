// The first pass of viewer/devices/gl/surface_renderer.h: what a pixel shows, to be lit once.

#if MOVES
in vec3 lit_position, lit_normal;

uniform vec3 moved_low, moved_size; // of the box of lit positions
#endif

#if MIRROR
uniform float in_mirror; // 1 = what a flat mirror shows
#endif

out uvec4 described;

void main()
{
#if MASKED
    if (coverage() < more.y) discard;
#endif
    Shaded s = shade();
#if MIRROR
    if (in_mirror > 0.0 && s.is_pane) discard;
#endif
#if MOVES && !EMITS
    described = describe_moved(s.albedo, normalize(s.normal + lit_normal - normal), s.gloss, (lit_position - moved_low) / moved_size);
#else
    described = describe(s.albedo, s.normal, s.gloss, s.emitted);
#endif
}
