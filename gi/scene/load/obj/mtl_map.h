#pragma once
// A map of MTL: its file, and options such as `-s 2 2 1 -o 0.5 0 0 -clamp on` (Wavefront, appendix B2 of its
// Advanced Visualizer, "Options for texture map statements"). Many programs write them behind the file's name.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

struct MtlMap {
    std::string file; ///< as it is written, without quotes; empty = none
    float scale_u = 1, scale_v = 1;
    float offset_u = 0, offset_v = 0; ///< u' = scale_u * u + offset_u; v upwards
    bool clamped = false;             ///< one copy of the picture, not repeated
    float bump = 1;                   ///< strength of bumps and normals
    char channel = 0; ///< of `-imfchan`: r, g, b, m (alpha), l (luminance), z (depth); 0 = not stated
    std::vector<std::string> dropped; ///< options that change the picture and have no equivalent here: "-mm 0 2"
};

/// @param values  what follows `map_Kd`
MtlMap read_mtl_map(std::string_view values);

/// A finite number that is the whole word: "2", "+.5", but not "2.png".
std::optional<float> number_word(std::string_view word);

} // namespace gi
