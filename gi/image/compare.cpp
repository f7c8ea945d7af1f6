#include "gi/image/compare.h"

#include "gi/base/error.h"
#include "gi/image/flip.h"
#include "gi/image/metrics.h"
#include "gi/image/ssim.h"
#include "gi/image/tone_map.h"
#include "gi/image/ztest.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace gi {
namespace {

constexpr std::array kMetrics{
    MetricInfo{"rmse", "root of the mean squared difference, linear", true},
    MetricInfo{"relmse", "mean of (x - r)^2 / (r^2 + 0.01)", true},
    MetricInfo{"bias", "mean(x) / mean(r), over all and per channel", true},
    MetricInfo{"psnr", "dB, of the display-encoded pictures", true},
    MetricInfo{"ssim", "structural similarity of the display-encoded luminance", true},
    MetricInfo{"flip", "what an observer sees when the two alternate, 0..1", true},
    MetricInfo{"hdrflip", "FLIP over all exposures that the reference needs", false},
    MetricInfo{"ztest", "z = (x - r) / sqrt(var x + var r); needs the layer 'variance'", false},
};

Layer const& find_layer(Picture const& picture, std::string const& name, char const* which)
{
    if (Layer const* layer = picture.find(name)) return *layer;
    std::string known;
    for (Layer const& l : picture.layers) known += l.name + " ";
    throw InputError(fmt::format("the {} has no layer '{}'", which, name), "that is the layer to compare",
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

/// The two layers in one size and with three channels.
struct Pair {
    int width, height;
    Layer image, reference;
    std::vector<float> image_variance, reference_variance; ///< empty where there is none
    std::vector<std::string> notes;
};

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

Pair make_pair(Picture const& image, Picture const& reference, std::string const& layer)
{
    Pair p;
    p.image = {layer, 3, three_channels(find_layer(image, layer, "image"))};
    p.reference = {layer, 3, three_channels(find_layer(reference, layer, "reference"))};
    bool const beauty = layer == "color"; // the variance layer belongs to it
    if (Layer const* v = image.find("variance"); v != nullptr && beauty) p.image_variance = three_channels(*v);
    if (Layer const* v = reference.find("variance"); v != nullptr && beauty)
        p.reference_variance = three_channels(*v);

    p.width = std::min(image.width, reference.width);
    p.height = std::min(image.height, reference.height);
    auto const shrink = [&](Picture const& from, Layer& values, std::vector<float>& variance, char const* which) {
        if (from.width == p.width && from.height == p.height) return;
        int const factor = from.width / p.width;
        if (factor * p.width != from.width || factor * p.height != from.height)
            throw InputError(fmt::format("the pictures are {} x {} and {} x {}", image.width, image.height,
                                         reference.width, reference.height),
                             "only equal sizes or whole multiples can be compared", "render one of them again");
        values.data = average_down(values.data, from.width, from.height, 3, factor, 2);
        if (!variance.empty()) variance = average_down(variance, from.width, from.height, 3, factor, 4);
        p.notes.push_back(fmt::format("the {} was averaged down by {} x {}", which, factor, factor));
    };
    shrink(image, p.image, p.image_variance, "image");
    shrink(reference, p.reference, p.reference_variance, "reference");
    return p;
}

void drop_not_finite(Pair& p)
{
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < p.image.data.size(); ++i) {
        if (std::isfinite(p.image.data[i]) && std::isfinite(p.reference.data[i])) continue;
        p.image.data[i] = p.reference.data[i] = 0;
        ++dropped;
    }
    if (dropped > 0)
        p.notes.push_back(fmt::format("{} values that are not finite in one of the two left out", dropped));
}

std::vector<float> clipped(std::vector<float> v)
{
    for (float& x : v) x = std::clamp(x, 0.0f, 1.0f);
    return v;
}

double mean(std::vector<float> const& v)
{
    double sum = 0;
    for (float const x : v) sum += double(x);
    return sum / double(std::max<std::size_t>(1, v.size()));
}

std::vector<float> encoded_luminance(std::vector<float> const& encoded)
{
    std::vector<float> out;
    for (std::size_t i = 0; i + 2 < encoded.size(); i += 3)
        out.push_back(luminance({encoded[i], encoded[i + 1], encoded[i + 2]}));
    return out;
}

void run_metric(std::string const& name, Pair const& p, Comparison& out)
{
    auto const add = [&](std::string const& what, double value) { out.values.push_back({what, value}); };
    std::vector<float> const &x = p.image.data, &r = p.reference.data;
    if (name == "rmse") {
        add(name, measure_errors(x, r, 3).rmse);
    } else if (name == "relmse") {
        add(name, measure_errors(x, r, 3).relmse);
    } else if (name == "bias") {
        ErrorSums const e = measure_errors(x, r, 3);
        add("bias", e.mean_bias);
        add("bias.r", e.bias.x);
        add("bias.g", e.bias.y);
        add("bias.b", e.bias.z);
    } else if (name == "psnr") {
        add(name, psnr(tone_map(p.image, {}), tone_map(p.reference, {})));
    } else if (name == "ssim") {
        add(name, ssim(encoded_luminance(tone_map(p.image, {})), encoded_luminance(tone_map(p.reference, {})),
                       p.width, p.height));
    } else if (name == "flip") {
        add(name, mean(flip(clipped(x), clipped(r), p.width, p.height)));
    } else if (name == "hdrflip") {
        add(name, mean(hdr_flip(x, r, p.width, p.height)));
    } else if (name == "ztest") {
        if (p.image_variance.empty())
            throw InputError("the image has no variance for its layer", "a z-test needs to know its noise",
                             "render it with the layer 'variance', and compare the layer 'color'");
        if (p.reference_variance.empty())
            out.notes.push_back("the reference is taken as exact: it has no variance");
        ZTest const z = z_test(x, p.image_variance, r, p.reference_variance);
        add("ztest.mean_z", z.mean_z);
        add("ztest.beyond_2", z.beyond_2);
        add("ztest.beyond_3", z.beyond_3);
        add("ztest.largest", z.largest);
        add("ztest.sidak_p", z.sidak_p);
    }
}

} // namespace

std::span<MetricInfo const> metrics() { return kMetrics; }

Comparison compare(Picture const& image, Picture const& reference, std::vector<std::string> const& names,
                   std::string const& layer)
{
    std::vector<std::string> chosen = names;
    if (chosen.empty())
        for (MetricInfo const& m : kMetrics)
            if (m.by_default) chosen.emplace_back(m.name);
    for (std::string const& name : chosen)
        if (std::none_of(kMetrics.begin(), kMetrics.end(), [&](MetricInfo const& m) { return m.name == name; })) {
            std::string known;
            for (MetricInfo const& m : kMetrics) known += fmt::format("{} ", m.name);
            throw InputError("there is no metric '" + name + "'", "it is not known here", "choose from: " + known);
        }
    Pair p = make_pair(image, reference, layer);
    drop_not_finite(p);
    Comparison out;
    out.notes = p.notes;
    for (std::string const& name : chosen) run_metric(name, p, out);
    return out;
}

std::vector<unsigned char> difference_image(Picture const& image, Picture const& reference,
                                            std::string const& layer, int& width, int& height)
{
    Pair p = make_pair(image, reference, layer);
    drop_not_finite(p);
    width = p.width;
    height = p.height;
    // Control points of the magma scale, evenly spaced.
    static constexpr std::array<std::array<float, 3>, 6> kScale{{{0.001f, 0.000f, 0.014f},
                                                                 {0.232f, 0.060f, 0.438f},
                                                                 {0.550f, 0.161f, 0.506f},
                                                                 {0.868f, 0.288f, 0.409f},
                                                                 {0.995f, 0.624f, 0.427f},
                                                                 {0.987f, 0.991f, 0.750f}}};
    std::vector<unsigned char> out;
    for (float const v : flip(clipped(p.image.data), clipped(p.reference.data), width, height)) {
        float const at = std::clamp(v, 0.0f, 1.0f) * float(kScale.size() - 1);
        auto const i = std::min(std::size_t(at), kScale.size() - 2);
        for (std::size_t c = 0; c < 3; ++c)
            out.push_back(
                static_cast<unsigned char>(255 * glm::mix(kScale[i][c], kScale[i + 1][c], at - float(i)) + 0.5f));
    }
    return out;
}

} // namespace gi
