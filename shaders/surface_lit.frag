// The second pass of viewer/devices/gl/surface_renderer.h: lights what the first one has described.

layout(binding = 4) uniform usampler2D surfaces;

uniform mat3 world_from_pixel; // to directions from the eye with a depth of 1
uniform vec3 eye, moved_low, moved_size;

out vec4 color;

void main()
{
    uvec4 s = texelFetch(surfaces, ivec2(gl_FragCoord.xy), 0);
    vec3 at = has_moved(s) ? moved_low + moved_size * place_in_box(s)
                           : eye + uintBitsToFloat(s.z) * (world_from_pixel * vec3(gl_FragCoord.xy, 1.0));
    color = vec4(emission_of(s) + albedo_of(s) * find_light(at, unpack_normal(s.x)), 1.0);
}
