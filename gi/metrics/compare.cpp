#include "gi/metrics/compare.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/filter/tone_map.h"
#include "gi/metrics/flip.h"
#include "gi/metrics/metrics.h"
#include "gi/metrics/picture_pair.h"
#include "gi/metrics/provenance.h"
#include "gi/metrics/ssim.h"
#include "gi/metrics/ztest.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace gi {
namespace {

constexpr std::array kMetrics{
    MetricInfo{"rmse", "root of the mean squared difference, linear", true},
    MetricInfo{"relmse", "mean of (x - r)^2 / (r^2 + 0.01)", true},
    MetricInfo{"bias", "mean(x) / mean(r), 1 = equally bright, over all and per channel; bias.error = |bias - 1|",
               true},
    MetricInfo{"psnr", "dB, of the display-encoded pictures", true},
    MetricInfo{"ssim", "structural similarity of the display-encoded luminance", true},
    MetricInfo{"flip", "difference visible when the two alternate, 0..1", true},
    MetricInfo{"hdrflip", "FLIP over all exposures that the reference needs", false},
    MetricInfo{"ztest", "z = (x - r) / sqrt(var x + var r + rounding); needs the layer 'variance'", false},
};

/// Of a value per pixel, over the pixels whose values are finite in both pictures; NaN = there is none.
double mean_of_finite(std::vector<float> const& v, PicturePair const& p)
{
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (!p.is_finite(i)) continue;
        sum += double(v[i]);
        ++n;
    }
    return sum / double(n);
}

/// The encoded values of pixels that are finite in both pictures.
std::vector<float> finite_ones(std::vector<float> const& encoded, PicturePair const& p)
{
    std::vector<float> out;
    for (std::size_t i = 0; i < encoded.size() / 3; ++i)
        if (p.is_finite(i)) out.insert(out.end(), &encoded[3 * i], &encoded[3 * i] + 3);
    return out;
}

std::vector<float> encoded_luminance(std::vector<float> const& encoded)
{
    std::vector<float> out;
    for (std::size_t i = 0; i + 2 < encoded.size(); i += 3)
        out.push_back(luminance({encoded[i], encoded[i + 1], encoded[i + 2]}));
    return out;
}

void run_metric(std::string const& name, PicturePair const& p, Comparison& out)
{
    auto const add = [&](std::string const& what, double value) { out.values.push_back({what, value}); };
    std::vector<float> const &x = p.image, &r = p.reference;
    auto const encoded = [](Layer const& l) { return tone_map(l, {}); };
    if (name == "rmse") {
        add(name, measure_errors(x, r, 3).rmse);
    } else if (name == "relmse") {
        add(name, measure_errors(x, r, 3).relmse);
    } else if (name == "bias") {
        ErrorSums const e = measure_errors(x, r, 3);
        add("bias", e.mean_bias);
        add("bias.error", std::abs(e.mean_bias - 1));
        add("bias.r", e.bias.x);
        add("bias.g", e.bias.y);
        add("bias.b", e.bias.z);
    } else if (name == "psnr") {
        add(name, psnr(finite_ones(encoded(p.finite_image), p), finite_ones(encoded(p.finite_reference), p)));
    } else if (name == "ssim") {
        add(name, ssim(encoded_luminance(encoded(p.finite_image)), encoded_luminance(encoded(p.finite_reference)),
                       p.width, p.height));
    } else if (name == "flip") {
        add(name,
            mean_of_finite(flip(clipped(p.finite_image), clipped(p.finite_reference), p.width, p.height), p));
    } else if (name == "hdrflip") {
        add(name, mean_of_finite(hdr_flip(p.finite_image.data, p.finite_reference.data, p.width, p.height), p));
    } else if (name == "ztest") {
        if (p.image_variance.empty())
            throw InputError("the image has no variance for its layer", "a z-test needs the variance of its noise",
                             "render it with the layer 'variance', and compare the layer 'color'");
        if (p.reference_variance.empty())
            out.notes.push_back("the reference is taken as exact: it has no variance");
        ZTest const z = z_test(x, p.image_variance, r, p.reference_variance);
        add("ztest.mean_z", z.mean_z);
        add("ztest.beyond_2", z.beyond_2);
        add("ztest.beyond_3", z.beyond_3);
        add("ztest.largest", z.largest);
        add("ztest.sidak_p", z.sidak_p);
        add("ztest.mean_p", z.mean_p);
        add("ztest.chi2_p", z.chi2_p);
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
            std::vector<std::string> known;
            for (MetricInfo const& m : kMetrics) known.emplace_back(m.name);
            throw InputError("there is no metric '" + name + "'", "it is not known here", suggest(name, known));
        }
    PicturePair const p = pair_up(image, reference, layer);
    Comparison out;
    out.notes = p.notes;
    for (std::string const& name : chosen) run_metric(name, p, out);
    auto const measured = std::ranges::find(out.values, "relmse", &NamedValue::name);
    auto const notes =
        provenance_notes(image, reference, measured == out.values.end() ? std::nan("") : measured->value,
                         std::ranges::find(chosen, "ztest") != chosen.end());
    out.notes.insert(out.notes.end(), notes.begin(), notes.end());
    return out;
}

} // namespace gi
