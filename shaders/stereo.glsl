// Which eye a pixel belongs to, and colours of both in one: viewer/displays/compose.cpp for the GPU. MODE is the
// StereoMode, whose names are defines.

uniform mat3 dubois_left, dubois_right;

const bool kAnaglyph = MODE == STEREO_anaglyph_red_cyan || MODE == STEREO_anaglyph_dubois;

/// Left = 0, right = 1, neither = 2; place: the pixel of that eye. For modes where each pixel shows one eye.
int eye_of(ivec2 pixel, ivec2 eye_size, ivec2 on_screen, out ivec2 place)
{
    place = pixel;
    ivec2 s = on_screen + pixel;
    if (MODE == STEREO_side_by_side) {
        int eye = pixel.x < eye_size.x ? 0 : (pixel.x < 2 * eye_size.x ? 1 : 2);
        place.x -= eye * eye_size.x;
        return eye;
    }
    if (MODE == STEREO_top_bottom) {
        int eye = pixel.y < eye_size.y ? 0 : (pixel.y < 2 * eye_size.y ? 1 : 2);
        place.y -= eye * eye_size.y;
        return eye;
    }
    if (MODE == STEREO_rows) return s.y & 1;
    if (MODE == STEREO_columns) return s.x & 1;
    if (MODE == STEREO_checkerboard) return (s.x + s.y) & 1;
    return 0;
}

vec3 anaglyph(vec3 left, vec3 right)
{
    if (MODE == STEREO_anaglyph_red_cyan) return vec3(left.r, right.gb);
    vec3 light = dubois_left * decode_srgb(left) + dubois_right * decode_srgb(right);
    return to_bytes(encode_srgb(clamp(light, 0.0, 1.0)));
}
