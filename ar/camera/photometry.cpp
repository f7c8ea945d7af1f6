#include "ar/camera/photometry.h"

#include <algorithm>
#include <cmath>

namespace ar {
namespace {

double known_ratio(double a, double b) { return a > 0 && b > 0 ? a / b : 1.0; }

/// IEC 61966-2-1. @param v  0..1
float srgb_unit(double v) { return float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)); }

bool has_vignetting(Photometry const& p) { return p.vignetting != std::array<double, 3>{}; }

/// Finds the byte with the nearest unit by a table over cells of units and a short search.
class Encoder {
public:
    explicit Encoder(std::array<float, 256> const& unit_of_byte) : unit_(unit_of_byte)
    {
        scale_ = unit_[255] > unit_[0] ? float(first_.size() - 1) / (unit_[255] - unit_[0]) : 0;
        std::size_t byte = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            float const from = scale_ > 0 ? unit_[0] + float(i) / scale_ : unit_[0];
            while (byte < 255 && unit_[byte + 1] <= from) ++byte;
            first_[i] = std::uint8_t(byte);
        }
    }
    std::uint8_t operator()(float unit) const
    {
        if (!(unit > unit_[0])) return 0;
        if (unit >= unit_[255]) return 255;
        auto const cell = std::size_t((unit - unit_[0]) * scale_);
        std::size_t byte = first_[std::min(cell, first_.size() - 1)];
        while (byte > 0 && unit_[byte] > unit) --byte; // rounding of the cell's border
        while (byte < 255 && unit_[byte + 1] <= unit) ++byte;
        return byte < 255 && unit_[byte + 1] - unit < unit - unit_[byte] ? std::uint8_t(byte + 1)
                                                                         : std::uint8_t(byte);
    }

private:
    std::array<float, 256> const& unit_;
    std::array<std::uint8_t, 4096> first_;
    float scale_ = 0;
};

} // namespace

double relative_exposure(Exposure const& e, Exposure const& reference)
{
    return known_ratio(e.time_s, reference.time_s) * known_ratio(e.gain, reference.gain);
}

cv::Vec3f relative_gains(Exposure const& e, Exposure const& reference)
{
    double const all = relative_exposure(e, reference);
    return {float(all * known_ratio(e.red_gain, reference.red_gain)), float(all),
            float(all * known_ratio(e.blue_gain, reference.blue_gain))};
}

Photometry srgb_photometry()
{
    Photometry p;
    for (std::size_t i = 0; i < 256; ++i) p.unit_of_byte[0][i] = srgb_unit(double(i) / 255);
    p.unit_of_byte[1] = p.unit_of_byte[2] = p.unit_of_byte[0];
    return p;
}

std::shared_ptr<std::vector<float> const> units_of_16_bits(std::array<float, 256> const& unit_of_byte)
{
    static auto const srgb = [] {
        std::vector<float> units(65536);
        for (std::size_t i = 0; i < units.size(); ++i) units[i] = srgb_unit(double(i) / 65535);
        return std::make_shared<std::vector<float> const>(std::move(units));
    }();
    static auto const srgb_bytes = srgb_photometry().unit_of_byte[0];
    if (unit_of_byte == srgb_bytes) return srgb;
    std::vector<float> units(65536);
    for (std::size_t i = 0; i < units.size(); ++i) {
        std::size_t const byte = std::min<std::size_t>(i / 257, 254);
        float const t = float(i - 257 * byte) / 257;
        units[i] = t < 1 ? unit_of_byte[byte] + t * (unit_of_byte[byte + 1] - unit_of_byte[byte])
                         : unit_of_byte[byte + 1];
    }
    return std::make_shared<std::vector<float> const>(std::move(units));
}

double vignetting_at(Photometry const& p, cv::Size size, int x, int y)
{
    double const dx = x + 0.5 - 0.5 * size.width, dy = y + 0.5 - 0.5 * size.height;
    double const r2 =
        4 * (dx * dx + dy * dy) / (double(size.width) * size.width + double(size.height) * size.height);
    return 1 + r2 * (p.vignetting[0] + r2 * (p.vignetting[1] + r2 * p.vignetting[2]));
}

namespace {

/// @param units  of each channel's codes
template <typename Pixel>
cv::Mat decoded_radiance(cv::Mat const& rgb, std::array<float const*, 3> const& units, Photometry const& p,
                         Exposure const& exposure)
{
    cv::Mat out(rgb.size(), CV_32FC3);
    cv::Vec3f scale;
    cv::Vec3f const gains = relative_gains(exposure, p.reference);
    for (int c = 0; c < 3; ++c) scale[c] = float(p.radiance_per_unit / gains[c]);
    bool const vignetted = has_vignetting(p), coloured = p.colour != cv::Matx33f::eye();
    cv::parallel_for_({0, rgb.rows}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y) {
            auto const* in = rgb.ptr<Pixel>(y);
            auto* to = out.ptr<cv::Vec3f>(y);
            for (int x = 0; x < rgb.cols; ++x) {
                cv::Vec3f v(units[0][in[x][0]], units[1][in[x][1]], units[2][in[x][2]]);
                if (vignetted) v *= float(1 / vignetting_at(p, rgb.size(), x, y));
                v = v.mul(scale);
                to[x] = coloured ? p.colour * v : v;
            }
        }
    });
    return out;
}

} // namespace

cv::Mat radiance_of(cv::Mat const& rgb, Photometry const& p, Exposure const& exposure)
{
    CV_Assert(rgb.type() == CV_8UC3 || rgb.type() == CV_16UC3 || rgb.type() == CV_32FC3);
    if (rgb.depth() == CV_32F) return rgb;
    if (rgb.depth() == CV_8U)
        return decoded_radiance<cv::Vec3b>(
            rgb, {p.unit_of_byte[0].data(), p.unit_of_byte[1].data(), p.unit_of_byte[2].data()}, p, exposure);
    auto const red = units_of_16_bits(p.unit_of_byte[0]), green = units_of_16_bits(p.unit_of_byte[1]),
               blue = units_of_16_bits(p.unit_of_byte[2]);
    return decoded_radiance<cv::Vec3w>(rgb, {red->data(), green->data(), blue->data()}, p, exposure);
}

cv::Mat bytes_of(cv::Mat const& radiance, Photometry const& p, Exposure const& exposure)
{
    CV_Assert(radiance.type() == CV_32FC3);
    cv::Mat out(radiance.size(), CV_8UC3);
    std::array<Encoder, 3> const encode{Encoder(p.unit_of_byte[0]), Encoder(p.unit_of_byte[1]),
                                        Encoder(p.unit_of_byte[2])};
    cv::Vec3f const scale = relative_gains(exposure, p.reference) * (1 / p.radiance_per_unit);
    bool const vignetted = has_vignetting(p), coloured = p.colour != cv::Matx33f::eye();
    cv::Matx33f const camera_colour = p.colour.inv();
    cv::parallel_for_({0, radiance.rows}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y) {
            auto const* in = radiance.ptr<cv::Vec3f>(y);
            auto* to = out.ptr<cv::Vec3b>(y);
            for (int x = 0; x < radiance.cols; ++x) {
                cv::Vec3f v = scale.mul(coloured ? camera_colour * in[x] : in[x]);
                if (vignetted) v *= float(vignetting_at(p, radiance.size(), x, y));
                for (int c = 0; c < 3; ++c) to[x][c] = encode[std::size_t(c)](v[c]);
            }
        }
    });
    return out;
}

cv::Mat is_clipped(cv::Mat const& rgb)
{
    CV_Assert(rgb.type() == CV_8UC3 || rgb.type() == CV_16UC3 || rgb.type() == CV_32FC3);
    if (rgb.depth() == CV_32F) return cv::Mat::zeros(rgb.size(), CV_8UC1);
    cv::Mat out(rgb.size(), CV_8UC1);
    if (rgb.depth() == CV_16U) {
        rgb.forEach<cv::Vec3w>([&](cv::Vec3w const& v, int const* at) {
            auto const [low, high] = std::minmax({v[0], v[1], v[2]});
            out.at<std::uint8_t>(at[0], at[1]) = low == 0 || high == 65535 ? 255 : 0;
        });
        return out;
    }
    rgb.forEach<cv::Vec3b>([&](cv::Vec3b const& v, int const* at) {
        auto const [low, high] = std::minmax({v[0], v[1], v[2]});
        out.at<std::uint8_t>(at[0], at[1]) = low == 0 || high == 255 ? 255 : 0;
    });
    return out;
}

} // namespace ar
