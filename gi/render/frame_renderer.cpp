#include "gi/render/frame_renderer.h"

#include <algorithm>

namespace gi {

void hide_pixels(Picture& picture, std::span<std::uint8_t const> hidden)
{
    for (Layer& layer : picture.layers) {
        if (layer.name == "motion") continue;
        for (std::size_t i = 0; i < hidden.size(); ++i)
            if (hidden[i] != 0) std::fill_n(&layer.data[i * std::size_t(layer.channels)], layer.channels, 0.0f);
    }
}

} // namespace gi
