#include "ar/composite/composite.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <mutex>

namespace ar {

enum class Output {
    codes, ///< the camera's, by its response
    units  ///< float, neither rounded nor with noise
};

namespace {

/// One frame's constants. @tparam Response  of a channel: ResponseTable, DeepResponse, LinearResponse
template <typename Response, Output kOutput>
struct Blending {
    using Code = typename Response::Code;
    using Pixel = cv::Vec<Code, 3>;
    using Out = std::conditional_t<kOutput == Output::codes, Pixel, cv::Vec3f>;
    static constexpr bool kIsLinear = std::is_same_v<Code, float>;

    std::array<Response, 3> const& response;
    CompositeSettings const& settings;
    cv::Matx33f to_unit;
    bool noisy;

    /// One channel: u the camera's unit, w and n with and without in units, a coverage.
    float blended(float u, float w, float n, float a, bool clipped, CompositeCounts& counts) const
    {
        if (a >= 1) return w;
        bool const at_limit = clipped && w < n && settings.clipped != ClippedBytes::as_measured;
        float const seen = at_limit && settings.clipped == ClippedBytes::model ? std::max(u, n) : u;
        if (a > 0) return w + (1 - a) * (seen - n);
        if ((at_limit || settings.blend == Blend::ratio) && w != n) {
            if (n > 0 && w >= 0 && w <= settings.largest_ratio * n) return seen * (w / n);
            ++counts.ratio_limited;
        }
        return seen + (w - n);
    }

    Out kept(Pixel const& camera) const
    {
        if constexpr (kOutput == Output::codes)
            return camera;
        else
            return {response[0].unit(camera[0]), response[1].unit(camera[1]), response[2].unit(camera[2])};
    }

    /// @param direct  null: unknown
    Out pixel(Pixel const& camera, cv::Vec3f const& with, cv::Vec3f const& without, float a,
              cv::Vec3f const* direct, float vignetting, cv::Vec3f const* random, CompositeCounts& counts) const
    {
        if (!(a >= 0 && a <= 1)) {
            if (std::isnan(a)) return ++counts.not_finite, kept(camera);
            ++counts.coverage_range;
            a = std::clamp(a, 0.0f, 1.0f);
        }
        bool const same = with == without;
        if (a == 0 && same) return ++counts.copied, kept(camera);
        if constexpr (kIsLinear)
            if (a < 1 && !is_finite(camera)) return ++counts.not_finite, kept(camera);
        if (!is_finite(with) || (a < 1 && !is_finite(without))) return ++counts.not_finite, kept(camera);
        counts.covered += a > 0;
        counts.clipped += a < 1 && std::max({camera[0], camera[1], camera[2]}) == Response::kWhite;
        cv::Vec3f const w = vignetting * (to_unit * with), n = vignetting * (to_unit * without);
        bool const parted = direct && a > 0 && a < 1;
        if (parted && !is_finite(*direct)) return ++counts.not_finite, kept(camera);
        cv::Vec3f const d = parted ? vignetting * (to_unit * *direct) : cv::Vec3f(0, 0, 0);
        Out out;
        for (int c = 0; c < 3; ++c) {
            Response const& f = response[std::size_t(c)];
            float const u = f.unit(camera[c]);
            bool const clipped = camera[c] == Response::kWhite;
            float v = parted ? d[c] + (1 - a) * blended(u, (w[c] - d[c]) / (1 - a), n[c], 0, clipped, counts)
                             : blended(u, w[c], n[c], a, clipped, counts);
            // Linear frames have noise below 0, which stays.
            if (float const least = kIsLinear ? std::min(u, 0.0f) : 0.0f; v < least) {
                ++counts.negative;
                v = least;
            }
            if constexpr (kOutput == Output::units) {
                out[c] = v;
                continue;
            }
            if (noisy) {
                // The camera's share already has noise: add only the missing part.
                float const there = (1 - a) * (1 - a) * settings.noise.variance(c, u);
                v += std::sqrt(std::max(0.0f, settings.noise.variance(c, v) - there)) * (*random)[c];
            }
            out[c] = a < 1 ? f.code_near(v, camera[c]) : f.code(v);
        }
        return out;
    }
};

} // namespace

CompositeCounts& CompositeCounts::operator+=(CompositeCounts const& o)
{
    pixels += o.pixels;
    copied += o.copied;
    covered += o.covered;
    clipped += o.clipped;
    negative += o.negative;
    ratio_limited += o.ratio_limited;
    not_finite += o.not_finite;
    coverage_range += o.coverage_range;
    return *this;
}

Compositor::Compositor(Photometry const& p, CompositeSettings const& settings)
    : photometry_(p),
      settings_(settings),
      response_{ResponseTable(p.unit_of_byte[0]), ResponseTable(p.unit_of_byte[1]),
                ResponseTable(p.unit_of_byte[2])}
{
    bool invertible = false;
    camera_colour_ = p.colour.inv(cv::DECOMP_LU, &invertible);
    if (!invertible)
        throw gi::InputError("the camera's colour matrix has no inverse", "radiance cannot be converted to bytes",
                             "calibrate colour again, or use the unit matrix");
    if (!(p.radiance_per_unit > 0) || !std::isfinite(p.radiance_per_unit))
        throw gi::InputError(fmt::format("radiance_per_unit = {}", p.radiance_per_unit), "it must be positive",
                             "give the radiance that has the unit 1");
    if (!(settings.largest_ratio >= 1))
        throw gi::InputError(fmt::format("largest_ratio = {}", settings.largest_ratio), "it must be 1 or more",
                             "leave it at 8");
    for (std::size_t c = 0; c < 3; ++c)
        if (!(settings.noise.constant[c] >= 0) || !(settings.noise.per_unit[c] >= 0))
            throw gi::InputError("a variance of noise below 0", "there is no such noise", "measure it again");
    if (settings.noise.any()) noise_ = NoiseField(settings.noise);
}

cv::Matx33f Compositor::unit_of_radiance(Exposure const& exposure) const
{
    cv::Vec3f const gains = relative_gains(exposure, photometry_.reference);
    return cv::Matx33f::diag(gains * (1 / photometry_.radiance_per_unit)) * camera_colour_;
}

CompositeCounts Compositor::operator()(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure,
                                       cv::Mat& out, std::uint64_t frame_number)
{
    if ((rgb.type() != CV_8UC3 && rgb.type() != CV_16UC3 && rgb.type() != CV_32FC3) || rgb.empty())
        throw gi::InputError("the camera's frame is not RGB of 8 or 16 bits or float",
                             "other formats are not supported", "convert it with picture_of()");
    check(pair, rgb.size());
    out.create(rgb.size(), rgb.type());
    return by_depth<Output::codes>(rgb, pair, exposure, out, frame_number);
}

cv::Mat Compositor::light(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure)
{
    check(pair, rgb.size());
    cv::Mat light(rgb.size(), CV_32FC3);
    by_depth<Output::units>(rgb, pair, exposure, light, 0);
    if (rgb.depth() == CV_32F) return light * photometry_.radiance_per_unit;
    cv::Matx33f const to_radiance = unit_of_radiance(exposure).inv();
    light.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
        v = to_radiance * (vignetting_.empty() ? v : v * (1 / vignetting_.at<float>(at[0], at[1])));
    });
    return light;
}

template <Output kOutput>
CompositeCounts Compositor::by_depth(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure,
                                     cv::Mat& out, std::uint64_t frame_number)
{
    if (rgb.depth() == CV_32F) {
        std::array<LinearResponse, 3> response;
        response.fill(LinearResponse(float(photometry_.radiance_per_unit)));
        return composited<kOutput>(rgb, pair, response, radiance_to_unit(), cv::Mat(), out, frame_number);
    }
    if (photometry_.vignetting != std::array<double, 3>{} && vignetting_.size() != rgb.size()) {
        vignetting_.create(rgb.size(), CV_32FC1);
        for (int y = 0; y < rgb.rows; ++y)
            for (int x = 0; x < rgb.cols; ++x)
                vignetting_.at<float>(y, x) = float(vignetting_at(photometry_, rgb.size(), x, y));
    }
    cv::Matx33f const to_unit = unit_of_radiance(exposure);
    if (rgb.depth() == CV_8U)
        return composited<kOutput>(rgb, pair, response_, to_unit, vignetting_, out, frame_number);
    if (!deep_response_)
        deep_response_ = {DeepResponse(photometry_.unit_of_byte[0]), DeepResponse(photometry_.unit_of_byte[1]),
                          DeepResponse(photometry_.unit_of_byte[2])};
    return composited<kOutput>(rgb, pair, *deep_response_, to_unit, vignetting_, out, frame_number);
}

cv::Matx33f Compositor::radiance_to_unit() const
{
    return cv::Matx33f::eye() * float(1 / photometry_.radiance_per_unit);
}

template <Output kOutput, typename Response>
CompositeCounts Compositor::composited(cv::Mat const& rgb, RenderedPair const& pair,
                                       std::array<Response, 3> const& response, cv::Matx33f const& to_unit,
                                       cv::Mat const& vignetting, cv::Mat& out, std::uint64_t frame_number) const
{
    using B = Blending<Response, kOutput>;
    using Pixel = typename B::Pixel;
    B const blending{response, settings_, to_unit, kOutput == Output::codes && settings_.noise.any()};
    cv::Point const start = noise_.offset(frame_number);
    CompositeCounts sum;
    std::mutex adding;
    cv::parallel_for_({0, rgb.rows}, [&](cv::Range const& rows) {
        CompositeCounts counts;
        for (int y = rows.start; y < rows.end; ++y) {
            auto const* camera = rgb.ptr<Pixel>(y);
            auto const *with = pair.with.ptr<cv::Vec3f>(y), *without = pair.without.ptr<cv::Vec3f>(y);
            auto const* coverage = pair.coverage.ptr<float>(y);
            auto const* direct = pair.direct.empty() ? nullptr : pair.direct.ptr<cv::Vec3f>(y);
            auto const* fall_off = vignetting.empty() ? nullptr : vignetting.ptr<float>(y);
            auto const* random =
                blending.noisy ? noise_.tile().ptr<cv::Vec3f>((y + start.y) % NoiseField::kSize) : nullptr;
            auto* to = out.ptr<typename B::Out>(y);
            for (int x = 0; x < rgb.cols; ++x)
                to[x] = blending.pixel(camera[x], with[x], without[x], coverage[x], direct ? direct + x : nullptr,
                                       fall_off ? fall_off[x] : 1.0f,
                                       random ? random + (x + start.x) % NoiseField::kSize : nullptr, counts);
        }
        std::lock_guard const lock(adding);
        sum += counts;
    });
    sum.pixels = rgb.total();
    return sum;
}

} // namespace ar
