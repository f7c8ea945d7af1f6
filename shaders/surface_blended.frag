// Surfaces that cover only a part of what is behind them, after all others (viewer/devices/gl/surface_renderer.h).

uniform vec3 eye;

out vec4 color;

void main()
{
    Shaded s = shade();
    vec4 light = find_light(eye + from_eye, s.normal);
    color = vec4(s.emitted + s.albedo * light.rgb, clamp(coverage(), 0.0, 1.0));
#if PUNCTUAL
    if (light.a > 0.0) color.rgb += light.a * punctual_light(eye + from_eye, s.normal, -normalize(from_eye), s.albedo, s.gloss);
#endif
}
