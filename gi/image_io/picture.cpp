#include "gi/image_io/picture.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_rows.h"

#include <algorithm>

namespace gi {

Layer const* Picture::find(std::string const& name) const
{
    auto const it = std::find_if(layers.begin(), layers.end(), [&](Layer const& l) { return l.name == name; });
    return it == layers.end() ? nullptr : &*it;
}

Layer* Picture::find(std::string const& name)
{
    return const_cast<Layer*>(static_cast<Picture const*>(this)->find(name));
}

Layer& Picture::add(std::string const& name, int channels)
{
    layers.push_back({name, channels, std::vector<float>(pixels() * std::size_t(channels), 0.0f)});
    return layers.back();
}

Layer const& color_of(Picture const& picture, std::string const& name)
{
    if (Layer const* const color = picture.find("color")) return *color;
    std::string layers;
    for (Layer const& l : picture.layers) layers += (layers.empty() ? "" : ", ") + l.name;
    throw InputError("'" + name + "' has no colours: no channels R, G and B, or Y, without a layer",
                     "these hold them, R, G and B together; its layers: " + layers,
                     "save the colours under these names");
}

Picture PictureRows::whole(StopRequest const* stop) const
{
    Picture all;
    for (int y = 0; y < height; y += kRowsAtOnce) {
        if (stop != nullptr && stop->requested()) throw Interrupted();
        Picture const some = read(y, std::min(kRowsAtOnce, height - y));
        for (std::size_t k = 0; k < some.layers.size(); ++k) {
            Layer const& from = some.layers[k];
            if (y == 0) {
                all.layers.push_back({from.name, from.channels, {}});
                all.layers[k].data.reserve(std::size_t(width) * std::size_t(height) * std::size_t(from.channels));
            }
            all.layers[k].data.insert(all.layers[k].data.end(), from.data.begin(), from.data.end());
        }
    }
    all.width = width;
    all.height = height;
    all.metadata = metadata;
    all.left = left;
    all.top = top;
    return all;
}

PictureRows rows_of(Picture const& picture)
{
    auto const read = [&picture](int first, int count) {
        Picture some;
        some.width = picture.width;
        some.height = count;
        for (Layer const& layer : picture.layers) {
            std::size_t const row = std::size_t(picture.width) * std::size_t(layer.channels);
            auto const begin = layer.data.begin() + std::ptrdiff_t(row * std::size_t(first));
            some.layers.push_back(
                {layer.name, layer.channels, {begin, begin + std::ptrdiff_t(row * std::size_t(count))}});
        }
        return some;
    };
    return {picture.width, picture.height, read, picture.metadata, picture.left, picture.top};
}

} // namespace gi
