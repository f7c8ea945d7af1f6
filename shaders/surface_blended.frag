// Surfaces that cover only a part of what is behind them, after all others (viewer/devices/gl/surface_renderer.h).

uniform vec3 eye;

out vec4 color;

void main()
{
    Shaded s = shade();
    color = vec4(s.emitted + s.albedo * find_light(eye + from_eye, s.normal), clamp(coverage(), 0.0, 1.0));
}
