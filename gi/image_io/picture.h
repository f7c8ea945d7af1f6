#pragma once
// A picture: named layers of equal size, linear values, row-major from the top left, channels interleaved.

#include "gi/image_io/primaries.h"

#include <map>
#include <string>
#include <vector>

namespace gi {

/// One named layer. data.size() == width * height * channels; channel c of pixel (x, y) is
/// data[(y * width + x) * channels + c].
struct Layer {
    std::string name; ///< "color", "L0", "albedo", "depth", ...
    int channels = 3; ///< 1 (Y), 3 (RGB or XYZ) or 4 (RGBA); others in files of other programs
    std::vector<float> data;
};

/// Layers are unique by name. "color" is the beauty layer, of 1, 3 or 4 channels: linear Rec. 709 radiance, W/(m2 sr).
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Layer> layers;
    std::map<std::string, std::string> metadata; ///< version, git hash, command, seed, settings, ...

    // Of files that were read:
    int left = 0, top = 0;                   ///< corner of the display window, where pixel (0, 0) is
    bool has_gaps = false;                   ///< a data window does not cover it: pixels there are 0, and unknown
    bool ends_at_one = false;                ///< 8 or 16 bits, decoded from sRGB: brighter light was cut off
    bool is_cube = false;                    ///< the six faces of an environment (OpenEXR's attribute envmap)
    std::optional<Primaries> primaries = {}; ///< those of its colours, where they are not of Rec. 709
    std::vector<std::string> notes = {};     ///< what was chosen, left out or converted: "its part 'A' ..."

    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    /// nullptr if there is no layer of that name.
    Layer const* find(std::string const& name) const;
    Layer* find(std::string const& name);
    /// Appends a zeroed layer and returns it. Invalidates earlier Layer pointers.
    Layer& add(std::string const& name, int channels);
};

/// The layer "color". @param name  of the file. @throws InputError there is none; its message names what is there
Layer const& color_of(Picture const& picture, std::string const& name);

inline vec3 rgb(Layer const& layer, std::size_t pixel)
{
    float const* p = layer.data.data() + pixel * std::size_t(layer.channels);
    return layer.channels >= 3 ? vec3{p[0], p[1], p[2]} : vec3{p[0]};
}

} // namespace gi
