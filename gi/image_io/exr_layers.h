#pragma once
// Which channels of an OpenEXR part belong together, and what they mean.

#include <ImfChannelList.h>
#include <string>
#include <vector>

namespace gi {

enum class ExrKind {
    rgb,              ///< R, G, B or R, G, B, A
    luminance,        ///< Y
    luminance_alpha,  ///< Y, A
    luminance_chroma, ///< Y, RY, BY or Y, RY, BY, A
    values            ///< no colours: depths, vectors, alpha alone, ...
};

struct ExrChannel {
    std::string name;           ///< in the file
    int step_x = 1, step_y = 1; ///< one sample for so many pixels
};

struct ExrLayer {
    std::string name; ///< of values without a layer their channels' ("Z", "XYZ"); empty = colours without a layer
    ExrKind kind = ExrKind::values;
    std::vector<ExrChannel> channels; ///< in the order of their kind; others R G B A, X Y Z W, U V, then by name
};

/// Channels by their names up to the last '.'. Colours (R, G, B and A; Y and A; Y, RY, BY and A) and vectors (X, Y,
/// Z, W) are one layer, any other channel beside them is one of its own: NAME.Z. R and G without B and without a layer
/// are the layer RG. Channels are also known by small letters and as red, green, blue and alpha, as Nuke writes them.
/// @param file  for messages. @throws InputError sub-sampled channels other than RY and BY
std::vector<ExrLayer> exr_layers(Imf::ChannelList const& channels, std::string const& file);

} // namespace gi
