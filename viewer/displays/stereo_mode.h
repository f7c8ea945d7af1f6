#pragma once
// Ways to show the pictures of two eyes in a window.

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace viewer {

enum class StereoMode {
    off,               ///< one picture, from between the eyes
    side_by_side,      ///< left eye in the left half
    top_bottom,        ///< left eye in the upper half
    anaglyph_red_cyan, ///< red of the left eye, green and blue of the right
    anaglyph_dubois,   ///< least-squares matrices for red/cyan glasses (Dubois 2001)
    rows,              ///< left eye on even rows, counted from the top of the window
    columns,           ///< left eye on even columns, counted from the left
    checkerboard,      ///< left eye where row + column is even
    quad_buffer,       ///< left and right back buffers of the driver
    two_windows,       ///< a window for each eye
};

inline constexpr std::array kStereoModes = {StereoMode::off,
                                            StereoMode::side_by_side,
                                            StereoMode::top_bottom,
                                            StereoMode::anaglyph_red_cyan,
                                            StereoMode::anaglyph_dubois,
                                            StereoMode::rows,
                                            StereoMode::columns,
                                            StereoMode::checkerboard,
                                            StereoMode::quad_buffer,
                                            StereoMode::two_windows};

/// The name in files and on the command line: "side-by-side", "anaglyph-dubois".
char const* name_of(StereoMode mode);
/// None if no mode has this name.
std::optional<StereoMode> stereo_mode(std::string_view name);
/// "off, side-by-side, ...", for messages and help.
std::string stereo_mode_names();

} // namespace viewer
