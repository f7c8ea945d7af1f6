// What an eye sees of a camera's picture that stands on a plane in the room. Black where the camera saw nothing.
layout(binding = 0) uniform sampler2D picture; // sRGB code, top row first
layout(binding = 1) uniform sampler2D lens;    // where each pixel of a pinhole camera is in the picture, px
uniform mat3 pinhole_from_eye;                 // of positions, px; the eye's from its top left corner
out vec4 color;

void main()
{
    color = vec4(0.0, 0.0, 0.0, 1.0);
    vec3 p = pinhole_from_eye * vec3(gl_FragCoord.xy, 1.0);
    if (!(p.z > 0.0)) return;
    // Pixels' middles have whole numbers in both.
    vec2 lens_px = vec2(textureSize(lens, 0)), picture_px = vec2(textureSize(picture, 0));
    vec2 ray = p.xy / p.z;
    if (any(lessThan(ray, vec2(0.0))) || any(greaterThan(ray, lens_px - 1.0))) return;
    vec2 at = textureLod(lens, (ray + 0.5) / lens_px, 0.0).xy;
    if (any(lessThan(at, vec2(-0.5))) || any(greaterThan(at, picture_px - 0.5))) return;
    color = vec4(textureLod(picture, (at + 0.5) / picture_px, 0.0).rgb, 1.0);
}
