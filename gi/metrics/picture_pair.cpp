#include "gi/metrics/picture_pair.h"

#include "gi/core/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

Layer const& find_layer(Picture const& picture, std::string const& name, char const* which)
{
    if (Layer const* layer = picture.find(name)) return *layer;
    std::string known;
    for (Layer const& l : picture.layers) known += l.name + " ";
    throw InputError(fmt::format("the {} has no layer '{}'", which, name),
                     name == "color" ? "its colours are R, G and B together, or Y, without a layer"
                                     : "that is the layer to compare",
                     "it has: " + known);
}

/// Mean of factor x factor blocks. @param power of `factor` in the divisor: 2 for values, 4 for variances of means
std::vector<float> average_down(std::vector<float> const& in, int width, int height, int channels, int factor,
                                int power)
{
    int const w = width / factor, h = height / factor;
    std::vector<double> sums(std::size_t(w) * std::size_t(h) * std::size_t(channels), 0.0);
    for (int y = 0; y < h * factor; ++y)
        for (int x = 0; x < w * factor; ++x)
            for (int c = 0; c < channels; ++c)
                sums[(std::size_t(y / factor) * std::size_t(w) + std::size_t(x / factor)) * std::size_t(channels) +
                     std::size_t(c)] +=
                    double(in[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels) +
                              std::size_t(c)]);
    std::vector<float> out;
    double const divisor = std::pow(double(factor), power);
    for (double const s : sums) out.push_back(float(s / divisor));
    return out;
}

std::vector<float> three_channels(Layer const& layer)
{
    std::vector<float> out;
    std::size_t const pixels = layer.data.size() / std::size_t(layer.channels);
    out.reserve(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        vec3 const c = rgb(layer, i);
        out.insert(out.end(), {c.x, c.y, c.z});
    }
    return out;
}

/// One picture of the pair, in its own size.
struct Side {
    char const* name;
    Picture const& picture;
    std::vector<float>&values, &variance;
};

void take(Side const& side, std::string const& layer, std::vector<std::string>& notes)
{
    Layer const& from = find_layer(side.picture, layer, side.name);
    side.values = three_channels(from);
    if (int const used = from.channels >= 3 ? 3 : 1; used < from.channels)
        notes.push_back(
            fmt::format("the first {} of {} channels of the {} are compared", used, from.channels, side.name));
    Layer const* const variance = side.picture.find("variance");
    if (variance != nullptr && layer == "color") side.variance = three_channels(*variance); // of the layer "color"
}

void shrink(Side const& side, PicturePair& p)
{
    int const width = side.picture.width, height = side.picture.height;
    if (width == p.width && height == p.height) return;
    int const factor = width / p.width;
    side.values = average_down(side.values, width, height, 3, factor, 2);
    if (!side.variance.empty()) side.variance = average_down(side.variance, width, height, 3, factor, 4);
    p.notes.push_back(fmt::format("the {} was averaged down by {} x {}", side.name, factor, factor));
}

bool is_multiple(Picture const& large, int width, int height)
{
    return large.width % width == 0 && large.height == height * (large.width / width);
}

/// Throws unless the display windows are the same, but for their resolution.
void check_windows(Picture const& image, Picture const& reference)
{
    auto const scaled = [](int at, int size) { return std::int64_t(at) * size; };
    if (scaled(image.left, reference.width) == scaled(reference.left, image.width) &&
        scaled(image.top, reference.height) == scaled(reference.top, image.height))
        return;
    throw InputError(fmt::format("the display windows start at ({}, {}) and ({}, {})", image.left, image.top,
                                 reference.left, reference.top),
                     "the pixels are not those of the same places", "save both with the same display window");
}

void drop_not_finite(PicturePair& p, std::string const& layer)
{
    p.finite_image = {layer, 3, p.image};
    p.finite_reference = {layer, 3, p.reference};
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < p.image.size(); ++i) {
        if (std::isfinite(p.image[i]) && std::isfinite(p.reference[i])) continue;
        p.finite_image.data[i] = p.finite_reference.data[i] = 0;
        ++dropped;
    }
    if (dropped == p.image.size())
        throw InputError("no value of the two pictures is finite in both", "there is nothing to compare",
                         "render them again");
    if (dropped > 0)
        p.notes.push_back(
            fmt::format("{} of {} values that are not finite in one of the two left out (black in both to ssim)",
                        dropped, p.image.size()));
}

} // namespace

bool PicturePair::is_finite(std::size_t pixel) const
{
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
        if (!std::isfinite(image[i]) || !std::isfinite(reference[i])) return false;
    return true;
}

PicturePair pair_up(Picture const& image, Picture const& reference, std::string const& layer)
{
    PicturePair p;
    p.width = std::min(image.width, reference.width);
    p.height = std::min(image.height, reference.height);
    if (!is_multiple(image, p.width, p.height) || !is_multiple(reference, p.width, p.height))
        throw InputError(fmt::format("the pictures are {} x {} and {} x {}", image.width, image.height,
                                     reference.width, reference.height),
                         "only equal sizes or whole multiples can be compared",
                         "render one of them with the --size of the other");
    check_windows(image, reference);
    for (auto const& [which, picture] : {std::pair{"image", &image}, std::pair{"reference", &reference}})
        for (std::string const& note : picture->notes) p.notes.push_back(fmt::format("the {}: {}", which, note));
    for (Side const& side : {Side{"image", image, p.image, p.image_variance},
                             Side{"reference", reference, p.reference, p.reference_variance}}) {
        take(side, layer, p.notes);
        shrink(side, p);
    }
    drop_not_finite(p, layer);
    return p;
}

std::vector<float> clipped(Layer const& layer)
{
    std::vector<float> v = layer.data;
    for (float& x : v) x = std::clamp(x, 0.0f, 1.0f);
    return v;
}

} // namespace gi
