#include "viewer/displays/stereo_mode.h"

namespace viewer {

char const* name_of(StereoMode mode)
{
    switch (mode) {
    case StereoMode::off:
        return "off";
    case StereoMode::side_by_side:
        return "side-by-side";
    case StereoMode::top_bottom:
        return "top-bottom";
    case StereoMode::anaglyph_red_cyan:
        return "anaglyph-red-cyan";
    case StereoMode::anaglyph_dubois:
        return "anaglyph-dubois";
    case StereoMode::rows:
        return "rows";
    case StereoMode::columns:
        return "columns";
    case StereoMode::checkerboard:
        return "checkerboard";
    case StereoMode::quad_buffer:
        return "quad-buffer";
    case StereoMode::two_windows:
        return "two-windows";
    }
    return "off";
}

std::optional<StereoMode> stereo_mode(std::string_view name)
{
    for (StereoMode const mode : kStereoModes)
        if (name == name_of(mode)) return mode;
    return {};
}

std::string stereo_mode_names()
{
    std::string names;
    for (StereoMode const mode : kStereoModes) names += (names.empty() ? "" : ", ") + std::string(name_of(mode));
    return names;
}

} // namespace viewer
