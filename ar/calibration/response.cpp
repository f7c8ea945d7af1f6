#include "ar/calibration/response.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace ar {
namespace {

constexpr int kDarkest = 16, kBrightest = 247; ///< range of bytes used for fitting: noise does not clip them
constexpr int kTerms = 6;
constexpr double kByteSigma = 0.5; ///< of quantisation and errors of the response

/// ln(unit) of a byte is a sum of these, and 0 at 255: a power law times a smooth curve.
std::array<double, kTerms> terms_of(int byte)
{
    double const x = std::max(byte, 1) / 255.;
    std::array<double, kTerms> t{std::log(x)};
    for (int k = 1; k < kTerms; ++k) t[std::size_t(k)] = std::pow(x, k) - 1;
    return t;
}

struct ChannelFit {
    cv::Vec<double, kTerms> terms;
    double disagreement = 0;
    int pairs = 0;
};

/// Two exposures of one pixel differ by the ratio of their times: linear in the terms.
ChannelFit fit_channel(Bracket const& b, std::vector<double> const& light, int channel)
{
    constexpr int kMostPixels = 20000;
    cv::Size const size = b.rgb[0].size();
    int const step = std::max(1, int(std::sqrt(double(size.area()) / kMostPixels)));
    std::array<std::array<double, kTerms>, 256> terms;
    for (int i = 0; i < 256; ++i) terms[std::size_t(i)] = terms_of(i);
    auto const for_pairs = [&](auto const& use) {
        for (int y = 0; y < size.height; y += step)
            for (int x = 0; x < size.width; x += step)
                for (std::size_t i = 0; i < b.rgb.size(); ++i)
                    for (std::size_t j = i + 1; j < b.rgb.size(); ++j) {
                        int const p = b.rgb[i].at<cv::Vec3b>(y, x)[channel];
                        int const q = b.rgb[j].at<cv::Vec3b>(y, x)[channel];
                        if (std::min(p, q) < kDarkest || std::max(p, q) > kBrightest) continue;
                        cv::Vec<double, kTerms> d;
                        for (int k = 0; k < kTerms; ++k)
                            d[k] = terms[std::size_t(p)][std::size_t(k)] - terms[std::size_t(q)][std::size_t(k)];
                        // One byte of noise is relatively larger for dark pixels.
                        use(d, std::log(light[i] / light[j]), 1 / (1. / (p * p) + 1. / (q * q)));
                    }
    };
    ChannelFit fit;
    cv::Matx<double, kTerms, kTerms> normal = cv::Matx<double, kTerms, kTerms>::zeros();
    cv::Vec<double, kTerms> right;
    for_pairs([&](auto const& d, double ratio, double w) {
        normal += w * d * d.t();
        right += w * ratio * d;
        ++fit.pairs;
    });
    if (fit.pairs < 200) return fit;
    fit.terms = normal.inv(cv::DECOMP_SVD) * right;
    double sum = 0, weights = 0;
    for_pairs([&](auto const& d, double ratio, double w) {
        sum += w * std::pow(d.dot(fit.terms) - ratio, 2);
        weights += w;
    });
    fit.disagreement = std::sqrt(sum / weights);
    return fit;
}

std::size_t middle_of(Bracket const& b)
{
    std::vector<std::size_t> order(b.rgb.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return relative_exposure(b.exposures[i], b.exposures[0]) <
               relative_exposure(b.exposures[j], b.exposures[0]);
    });
    return order[order.size() / 2];
}

} // namespace

void check(Bracket const& b, std::size_t fewest)
{
    auto const refuse = [](std::string const& problem, std::string const& why) {
        throw gi::InputError("a bracket of exposures: " + problem, why,
                             "take one scene several times from a tripod");
    };
    if (b.rgb.size() < fewest || b.rgb.size() != b.exposures.size())
        refuse(fmt::format("{} pictures and {} exposures", b.rgb.size(), b.exposures.size()),
               fmt::format("{} or more are needed, each with its own", fewest));
    double least = 1e300, most = 0;
    for (std::size_t i = 0; i < b.rgb.size(); ++i) {
        if (b.rgb[i].type() != CV_8UC3 || b.rgb[i].size() != b.rgb[0].size() || b.rgb[i].empty())
            refuse(fmt::format("picture {} is of another kind or size", i), "pixels are compared one by one");
        if (!(b.exposures[i].time_s > 0 && b.exposures[i].time_s < 1e6))
            refuse(fmt::format("picture {} has no exposure time", i), "ratios of light are made of it");
        double const light = relative_exposure(b.exposures[i], b.exposures[0]);
        least = std::min(least, light);
        most = std::max(most, light);
    }
    if (!(most > 1.05 * least)) refuse("all exposures are the same", "nothing says what bytes mean");
}

ResponseFit calibrate_response(Bracket const& b)
{
    check(b, 2);
    std::size_t const middle = middle_of(b);
    std::vector<double> light;
    for (auto const& e : b.exposures) light.push_back(relative_exposure(e, b.exposures[middle]));
    ResponseFit out;
    for (std::size_t c = 0; c < 3; ++c) {
        ChannelFit const fit = fit_channel(b, light, int(c));
        if (fit.pairs < 200)
            throw gi::InputError(
                fmt::format("{} pixels of channel {} are neither dark nor bright in two exposures", fit.pairs, c),
                "the response is learned from them", "take exposures a factor of 2 to 4 apart");
        out.disagreement[c] = fit.disagreement;
        auto& unit = out.photometry.unit_of_byte[c];
        for (int i = 0; i < 256; ++i) {
            auto const t = terms_of(i);
            double log_unit = 0;
            for (int k = 0; k < kTerms; ++k) log_unit += fit.terms[k] * t[std::size_t(k)];
            unit[std::size_t(i)] = i == 0 ? 0 : float(std::exp(std::min(log_unit, 20.)));
        }
        for (std::size_t i = 1; i < 256; ++i)
            if (unit[i] < unit[i - 1]) {
                unit[i] = unit[i - 1];
                ++out.levelled;
            }
    }
    out.photometry.reference = b.exposures[middle];
    return out;
}

MergedRadiance merge(Bracket const& b, Photometry const& photometry, MergeOptions const& options)
{
    check(b);
    std::size_t const n = b.rgb.size();
    std::vector<double> light;
    for (auto const& e : b.exposures) light.push_back(relative_exposure(e, photometry.reference));
    auto const shortest = std::size_t(std::min_element(light.begin(), light.end()) - light.begin());
    auto const longest = std::size_t(std::max_element(light.begin(), light.end()) - light.begin());
    // Sigma of a byte's unit: sensor noise, and quantisation times the local slope of the curve.
    std::array<std::array<double, 256>, 3> sigma{};
    std::array<std::array<bool, 256>, 3> clipped{}; // noise would clip part of it
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < 256; ++i) {
            auto const& unit = photometry.unit_of_byte[c];
            std::size_t const low = i >= 2 ? i - 2 : 0, high = std::min<std::size_t>(255, i + 2);
            double const slope = (unit[high] - unit[low]) / double(high - low);
            sigma[c][i] = std::max(1e-7, std::hypot(options.noise.sigma(unit[i]), slope * kByteSigma));
            clipped[c][i] =
                i <= 2 || i >= 253 || unit[i] - 3 * sigma[c][i] < unit[0] || unit[i] + 3 * sigma[c][i] > unit[255];
        }
    MergedRadiance out;
    cv::Size const size = b.rgb[0].size();
    cv::Mat units(size, CV_32FC3);
    out.standard_deviation.create(size, CV_32F);
    out.moved = cv::Mat::zeros(size, CV_8U);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            cv::Vec3f& to = units.at<cv::Vec3f>(y, x);
            bool moved = false;
            std::array<std::vector<std::array<double, 2>>, 3> said; // value and variance of each exposure
            for (std::size_t i = 0; i < n; ++i) {
                cv::Vec3b const byte = b.rgb[i].at<cv::Vec3b>(y, x);
                for (std::size_t c = 0; c < 3; ++c) {
                    std::uint8_t const v = byte[int(c)];
                    said[c].push_back({photometry.unit_of_byte[c][v] / light[i],
                                       clipped[c][v] ? 1e30 : std::pow(sigma[c][v] / light[i], 2)});
                }
            }
            cv::Vec3b const bright = b.rgb[shortest].at<cv::Vec3b>(y, x), dim = b.rgb[longest].at<cv::Vec3b>(y, x);
            out.saturated += std::max({bright[0], bright[1], bright[2]}) >= 253;
            out.dark += std::min({dim[0], dim[1], dim[2]}) <= 2;
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = 0, weight = 0;
                for (auto const& [value, variance] : said[c]) {
                    sum += value / variance;
                    weight += 1 / variance;
                }
                double const mean = sum / weight;
                if (weight > 1e-20)
                    for (std::size_t i = 0; i < n; ++i) {
                        // Expected value of this exposure, and its noise.
                        std::uint8_t const v = b.rgb[i].at<cv::Vec3b>(y, x)[int(c)];
                        double const expected = mean * light[i], seen = photometry.unit_of_byte[c][v];
                        double const reach =
                            options.moved_sigmas * std::hypot(options.noise.sigma(expected), sigma[c][v],
                                                              1 / std::sqrt(weight) * light[i]) +
                            0.03 * expected;
                        bool const may_be_white = v >= 253 && expected > seen,
                                   may_be_black = v <= 2 && expected < seen;
                        if (!may_be_white && !may_be_black && std::abs(seen - expected) > reach) moved = true;
                    }
                to[int(c)] = float(mean);
                if (weight <= 1e-20) { // clipped in all: use the shortest (white) or the longest (black)
                    std::size_t const from = bright[int(c)] >= 253 ? shortest : longest;
                    to[int(c)] = float(said[c][from][0]);
                }
                if (c == 1)
                    out.standard_deviation.at<float>(y, x) =
                        float(weight > 1e-20 ? std::sqrt(1 / weight) / std::max(mean, 1e-12) : 1);
            }
            if (!moved) continue;
            out.moved.at<std::uint8_t>(y, x) = 255;
            ++out.inconsistent;
            std::size_t best = 0;
            double least = 1e300;
            for (std::size_t i = 0; i < n; ++i) { // the same exposure for all channels
                double relative = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    relative += said[c][i][1] / std::pow(std::max(said[c][i][0], 1e-9), 2);
                if (relative < least) {
                    least = relative;
                    best = i;
                }
            }
            for (std::size_t c = 0; c < 3; ++c) to[int(c)] = float(said[c][best][0]);
        }
    // Apply vignetting and colour as in radiance_of.
    bool const vignetted = photometry.vignetting != std::array<double, 3>{};
    out.radiance.create(size, CV_32FC3);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            cv::Vec3f v = units.at<cv::Vec3f>(y, x);
            if (vignetted) {
                double const dx = x + 0.5 - 0.5 * size.width, dy = y + 0.5 - 0.5 * size.height;
                double const r2 = 4 * (dx * dx + dy * dy) /
                                  (double(size.width) * size.width + double(size.height) * size.height);
                auto const& g = photometry.vignetting;
                v *= float(1 / (1 + r2 * (g[0] + r2 * (g[1] + r2 * g[2]))));
            }
            out.radiance.at<cv::Vec3f>(y, x) = float(photometry.radiance_per_unit) * (photometry.colour * v);
        }
    return out;
}

} // namespace ar
