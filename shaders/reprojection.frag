// See viewer/devices/gl/reprojection.h.

out vec4 color;

void main() { color = reprojected(gl_FragCoord.xy); } // the target's top row is its first
