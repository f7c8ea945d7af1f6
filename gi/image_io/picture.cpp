#include "gi/image_io/picture.h"

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

} // namespace gi
