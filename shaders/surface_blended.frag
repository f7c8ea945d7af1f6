// Surfaces that cover only a part of what is behind them, after all others (viewer/devices/gl/surface_renderer.h).

uniform vec3 eye;

out vec4 color;

void main()
{
    Shaded s = shade();
    FoundLight f = find_light(eye + from_eye, s.normal);
    color = vec4(s.emitted + s.albedo * turned_to(f, s.normal), clamp(coverage(), 0.0, 1.0));
#if PUNCTUAL
    if (f.lacks > 0.0) color.rgb += f.lacks * punctual_light(eye + from_eye, s.normal, -normalize(from_eye), s.albedo, s.gloss);
#endif
}
