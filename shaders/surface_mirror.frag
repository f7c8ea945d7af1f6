// Mirrors and panes show what they did in the last picture, at the depth of its image (viewer/devices/gl/surface_renderer.h).

out vec4 color;

void main()
{
    if (!shade().is_mirror) discard;
    color = vec4(reprojected(gl_FragCoord.xy).rgb, 1.0);
}
