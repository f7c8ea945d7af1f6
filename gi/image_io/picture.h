#pragma once
// A picture: named layers of equal size, linear values, row-major from the top left, channels interleaved.

#include "gi/core/math.h"

#include <map>
#include <string>
#include <vector>

namespace gi {

/// One named layer. data.size() == width * height * channels; channel c of pixel (x, y) is
/// data[(y * width + x) * channels + c].
struct Layer {
    std::string name; ///< "color", "L0", "albedo", "depth", ...
    int channels = 3; ///< 1 (Y), 3 (RGB or XYZ) or 4 (RGBA)
    std::vector<float> data;
};

/// Layers are unique by name. "color" is the beauty layer: linear Rec. 709 radiance, W/(m2 sr).
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Layer> layers;
    std::map<std::string, std::string> metadata; ///< version, git hash, command, seed, settings, ...

    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    /// nullptr if there is no layer of that name.
    Layer const* find(std::string const& name) const;
    Layer* find(std::string const& name);
    /// Appends a zeroed layer and returns it. Invalidates earlier Layer pointers.
    Layer& add(std::string const& name, int channels);
};

inline vec3 rgb(Layer const& layer, std::size_t pixel)
{
    float const* p = layer.data.data() + pixel * std::size_t(layer.channels);
    return layer.channels >= 3 ? vec3{p[0], p[1], p[2]} : vec3{p[0]};
}

} // namespace gi
