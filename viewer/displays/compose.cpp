#include "viewer/displays/compose.h"

#include "gi/core/error.h"
#include "gi/filter/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace viewer {
namespace {

using Rgb = std::array<unsigned char, 3>;

struct EyePicture {
    std::span<unsigned char const> bytes;
    glm::ivec2 size;

    Rgb at(int x, int y) const
    {
        std::size_t const i = 3 * (std::size_t(y) * std::size_t(size.x) + std::size_t(x));
        return {bytes[i], bytes[i + 1], bytes[i + 2]};
    }
};

std::array<float, 256> decoded_bytes()
{
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < 256; ++i) table[i] = decode_srgb(float(i) / 255);
    return table;
}

Rgb dubois(Rgb left, Rgb right)
{
    static std::array<float, 256> const linear = decoded_bytes();
    static DuboisMatrices const matrices;
    Rgb out{};
    for (std::size_t k = 0; k < 3; ++k) {
        float sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
            sum += matrices.left[k][c] * linear[left[c]] + matrices.right[k][c] * linear[right[c]];
        out[k] = static_cast<unsigned char>(gi::encode_srgb(std::clamp(sum, 0.0f, 1.0f)) * 255 + 0.5f);
    }
    return out;
}

/// @param s position on the screen
Rgb pixel(StereoMode mode, EyePicture const& left, EyePicture const& right, int x, int y, glm::ivec2 s)
{
    auto const take_turns = [&](int number) { return (number & 1) == 0 ? left.at(x, y) : right.at(x, y); };
    auto const two_halves = [&](int from, int at) {
        glm::ivec2 const p = mode == StereoMode::top_bottom ? glm::ivec2(x, at % std::max(from, 1))
                                                            : glm::ivec2(at % std::max(from, 1), y);
        if (at < from) return left.at(p.x, p.y);
        return at < 2 * from ? right.at(p.x, p.y) : Rgb{};
    };
    switch (mode) {
    case StereoMode::off:
        return left.at(x, y);
    case StereoMode::side_by_side:
    case StereoMode::quad_buffer:
    case StereoMode::two_windows:
        return two_halves(left.size.x, x);
    case StereoMode::top_bottom:
        return two_halves(left.size.y, y);
    case StereoMode::anaglyph_red_cyan:
        return {left.at(x, y)[0], right.at(x, y)[1], right.at(x, y)[2]};
    case StereoMode::anaglyph_dubois:
        return dubois(left.at(x, y), right.at(x, y));
    case StereoMode::rows:
        return take_turns(s.y);
    case StereoMode::columns:
        return take_turns(s.x);
    case StereoMode::checkerboard:
        return take_turns(s.x + s.y);
    }
    return {};
}

} // namespace

float decode_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

glm::ivec2 eye_size(StereoMode mode, glm::ivec2 window_px)
{
    auto const half = [](int px) { return std::max(px / 2, std::min(px, 1)); };
    if (mode == StereoMode::side_by_side) return {half(window_px.x), window_px.y};
    if (mode == StereoMode::top_bottom) return {window_px.x, half(window_px.y)};
    return window_px;
}

glm::ivec2 composed_size(StereoMode mode, glm::ivec2 window_px)
{
    bool const two = mode == StereoMode::quad_buffer || mode == StereoMode::two_windows;
    return two ? glm::ivec2(2 * window_px.x, window_px.y) : window_px;
}

std::vector<unsigned char> compose_stereo(StereoMode mode, std::span<unsigned char const> left,
                                          std::span<unsigned char const> right, glm::ivec2 window_px,
                                          glm::ivec2 on_screen_px)
{
    glm::ivec2 const eye = eye_size(mode, window_px), size = composed_size(mode, window_px);
    std::size_t const bytes = 3 * std::size_t(std::max(eye.x, 0)) * std::size_t(std::max(eye.y, 0));
    if (left.size() != bytes || (mode != StereoMode::off && right.size() != bytes))
        throw gi::InputError("the pictures of the eyes have " + std::to_string(left.size()) + " and " +
                                 std::to_string(right.size()) + " bytes",
                             std::string("mode ") + name_of(mode) + " needs " + std::to_string(bytes) + " of each",
                             "render each eye in the size that eye_size states");
    std::vector<unsigned char> out(3 * std::size_t(size.x) * std::size_t(size.y));
    EyePicture const l{left, eye}, r{right, eye};
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            Rgb const c = pixel(mode, l, r, x, y, on_screen_px + glm::ivec2(x, y));
            std::copy(c.begin(), c.end(),
                      out.begin() + std::ptrdiff_t(3 * (std::size_t(y) * std::size_t(size.x) + std::size_t(x))));
        }
    return out;
}

} // namespace viewer
