// See viewer/devices/gl/reprojection.h.

out vec4 color; // and w in B

void main()
{
    bool found;
    float depth_in_a;
    vec2 x = place_of(gl_FragCoord.xy, found, depth_in_a); // the target's top row is its first
    float w = w_at(x);
    color = vec4(color_at(x, found), max(w * depth_in_a / max(1.0 - w * b_in_a.z, 1e-6), 0.0));
}
