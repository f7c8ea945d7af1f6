#include "ar/composite/albedo_samples.h"

#include "gi/core/error.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

float luminance(cv::Vec3f const& v) { return 0.2126f * v[0] + 0.7152f * v[1] + 0.0722f * v[2]; }

float median_of_lit(cv::Mat const& white, cv::Mat const& surface)
{
    std::vector<float> values;
    for (int y = 0; y < white.rows; ++y)
        for (int x = 0; x < white.cols; ++x)
            if (float const l = luminance(white.at<cv::Vec3f>(y, x));
                surface.at<int>(y, x) >= 0 && std::isfinite(l) && l > 0)
                values.push_back(l);
    return values.empty() ? 0 : float(gi::median(std::move(values)));
}

bool is_at_border(cv::Mat const& surface, int x, int y, int reach)
{
    int const s = surface.at<int>(y, x);
    for (int j = std::max(0, y - reach); j <= std::min(surface.rows - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(surface.cols - 1, x + reach); ++i)
            if (surface.at<int>(j, i) != s) return true;
    return false;
}

struct Centre {
    cv::Vec3f median{0, 0, 0}, deviation{0, 0, 0};
};

Centre centre_of(std::span<AlbedoSample const> samples)
{
    Centre centre;
    std::vector<std::pair<float, float>> values(samples.size());
    for (int c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < samples.size(); ++i) values[i] = {samples[i].ratio[c], samples[i].weight};
        centre.median[c] = float(gi::weighted_median(values));
        for (std::size_t i = 0; i < samples.size(); ++i)
            values[i] = {std::abs(samples[i].ratio[c] - centre.median[c]), samples[i].weight};
        centre.deviation[c] = 1.4826f * float(gi::weighted_median(values));
    }
    return centre;
}

} // namespace

void check(AlbedoView const& view, int patch_count, bool with_places)
{
    cv::Size const size = view.radiance.size();
    auto const require = [&](cv::Mat const& picture, int type, bool needed, char const* name) {
        if (picture.empty() ? !needed : picture.type() == type && picture.size() == size) return;
        throw gi::InputError(
            fmt::format("'{}' of a view for albedos has {} x {} pixels of type {}", name, picture.cols,
                        picture.rows, cv::typeToString(picture.type())),
            fmt::format("{} x {} of {} are needed", size.width, size.height, cv::typeToString(type)),
            "give all pictures of one frame at one size");
    };
    require(view.radiance, CV_32FC3, true, "radiance");
    require(view.white, CV_32FC3, true, "white");
    require(view.surface, CV_32SC1, true, "surface");
    require(view.clipped, CV_8UC1, false, "clipped");
    require(view.weight, CV_32FC1, false, "weight");
    require(view.place, CV_32FC2, with_places, "place");
    double most = 0;
    cv::minMaxLoc(view.surface, nullptr, &most);
    if (most >= patch_count)
        throw gi::InputError(fmt::format("a surface has the number {}", most),
                             fmt::format("there are {} patches, counted from 0", patch_count),
                             "give the number of patches that the picture of surfaces was made with");
}

void for_samples(AlbedoView const& view, AlbedoSettings const& settings, AlbedoFit& fit,
                 std::function<void(int, int, int, AlbedoSample const&)> const& use)
{
    float const middle = median_of_lit(view.white, view.surface), least = settings.least_white * middle;
    for (int y = 0; y < view.radiance.rows; ++y)
        for (int x = 0; x < view.radiance.cols; ++x) {
            int const patch = view.surface.at<int>(y, x);
            if (patch < 0) continue;
            cv::Vec3f const seen = view.radiance.at<cv::Vec3f>(y, x), white = view.white.at<cv::Vec3f>(y, x);
            float const confidence = view.weight.empty() ? 1 : view.weight.at<float>(y, x);
            if (confidence == 0) continue;
            if (!std::isfinite(seen[0] + seen[1] + seen[2] + white[0] + white[1] + white[2] + confidence) ||
                confidence < 0)
                ++fit.not_finite;
            else if (!view.clipped.empty() && view.clipped.at<uchar>(y, x))
                ++fit.clipped;
            else if (std::min({white[0], white[1], white[2]}) <= least)
                ++fit.dark;
            else if (is_at_border(view.surface, x, y, settings.border_px))
                ++fit.border;
            else
                use(patch, y, x,
                    {{seen[0] / white[0], seen[1] / white[1], seen[2] / white[2]},
                     confidence * luminance(white) / middle});
        }
}

PatchAlbedo robust_albedo(std::vector<AlbedoSample>& samples, AlbedoSettings const& settings,
                          std::size_t& specular, std::size_t& clamped)
{
    PatchAlbedo patch;
    if (samples.empty()) return patch;
    Centre centre = centre_of(samples);
    if (settings.specular > 0) {
        auto const is_bright = [&](AlbedoSample const& s) {
            for (int c = 0; c < 3; ++c)
                if (s.ratio[c] > centre.median[c] + settings.specular * centre.deviation[c] + 1e-4f) return true;
            return false;
        };
        auto const first =
            std::partition(samples.begin(), samples.end(), [&](AlbedoSample const& s) { return !is_bright(s); });
        specular += std::size_t(samples.end() - first);
        samples.erase(first, samples.end());
        centre = centre_of(samples);
    }
    for (int c = 0; c < 3; ++c) {
        patch.albedo[c] = std::clamp(centre.median[c], 0.0f, settings.largest);
        clamped += patch.albedo[c] != centre.median[c];
    }
    patch.spread = centre.deviation;
    patch.samples = samples.size();
    return patch;
}

} // namespace ar
