// One triangle that covers the viewport.
void main()
{
    gl_ClipDistance[0] = 1.0; // the planes of flat mirrors do not cut it
    vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(2.0 * p - 1.0, 0.0, 1.0);
}
