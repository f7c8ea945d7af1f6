// Radiance RGBE pictures (Ward, "Real Pixels", Graphics Gems II 1991), old and new run-length encoding.

#include "gi/core/error.h"
#include "gi/core/math.h"
#include "gi/image_io/picture_file.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

namespace gi {
namespace {

constexpr int kLargestHdrSide = 65536;
constexpr std::size_t kMostHdrPixels = std::size_t(1) << 29;

class HdrReader {
public:
    HdrReader(std::span<unsigned char const> bytes, std::string const& name) : bytes_(bytes), name_(name) {}

    Picture read()
    {
        Picture picture;
        read_header(picture);
        Layer& layer = picture.add("color", 3);
        std::vector<unsigned char> row(std::size_t(picture.width) * 4);
        for (int y = 0; y < picture.height; ++y) {
            read_row(row);
            float* out = layer.data.data() + std::size_t(y) * std::size_t(picture.width) * 3;
            for (std::size_t x = 0; x < std::size_t(picture.width); ++x, out += 3) {
                unsigned char const* const p = row.data() + 4 * x;
                float const scale = p[3] == 0 ? 0.0f : std::ldexp(1.0f, int(p[3]) - (128 + 8));
                for (int c = 0; c < 3; ++c) out[c] = float(p[c]) * scale / multiplied_[c];
            }
        }
        return picture;
    }

private:
    [[noreturn]] void fail(std::string const& why) const
    {
        throw InputError("cannot read '" + name_ + "' as Radiance HDR", why,
                         "copy it again if it was cut off, else save it as Radiance RGBE or OpenEXR");
    }
    unsigned char next()
    {
        if (at_ >= bytes_.size()) fail("it ends too early");
        return bytes_[at_++];
    }
    std::string_view next_line()
    {
        auto const* const begin = reinterpret_cast<char const*>(bytes_.data()) + at_;
        auto const* const end = static_cast<char const*>(std::memchr(begin, '\n', bytes_.size() - at_));
        if (end == nullptr) fail("its header does not end");
        at_ += std::size_t(end - begin) + 1;
        std::string_view line(begin, std::size_t(end - begin));
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }
    int read_side(std::string_view& line, std::string_view axis)
    {
        if (!line.starts_with(axis)) fail("its axes are not '-Y height +X width'");
        line.remove_prefix(axis.size());
        int value = 0;
        auto const [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
        if (error != std::errc{} || value < 1 || value > kLargestHdrSide)
            fail("its size is not between 1 and 65536");
        line.remove_prefix(std::size_t(end - line.data()));
        if (line.starts_with(' ')) line.remove_prefix(1);
        return value;
    }
    /// EXPOSURE and COLORCORR lines give factors that the radiances were multiplied by; several lines accumulate.
    void read_variable(std::string_view line)
    {
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            fail(fmt::format("'{}' is not RGB", line));
        bool const exposure = line.starts_with("EXPOSURE="), color = line.starts_with("COLORCORR=");
        if (!exposure && !color) return;
        line.remove_prefix(line.find('=') + 1);
        vec3 factor{1};
        for (int c = 0; c < (color ? 3 : 1); ++c) {
            line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
            auto const [end, error] = std::from_chars(line.data(), line.data() + line.size(), factor[c]);
            if (error != std::errc{} || !(factor[c] > 1e-20f) || !(factor[c] < 1e20f))
                fail("its exposure is not a positive number");
            line.remove_prefix(std::size_t(end - line.data()));
        }
        multiplied_ *= color ? factor : vec3{factor.x};
    }
    void read_header(Picture& picture)
    {
        if (std::string_view const magic = next_line(); !magic.starts_with("#?"))
            fail("it does not start with '#?'");
        for (std::string_view line = next_line(); !line.empty(); line = next_line()) read_variable(line);
        std::string_view size = next_line();
        picture.height = read_side(size, "-Y ");
        picture.width = read_side(size, "+X ");
        if (picture.pixels() > kMostHdrPixels) fail("it has more than 512 M pixels");
        // The new run-length encoding stores at most 127 values in two bytes; constant rows in the old one more.
        if (picture.pixels() / 512 > bytes_.size()) fail("it is too short for its size");
    }
    void read_row(std::vector<unsigned char>& row)
    {
        std::size_t const width = row.size() / 4;
        if (at_ + 4 <= bytes_.size() && width >= 8 && width < 32768 && bytes_[at_] == 2 && bytes_[at_ + 1] == 2 &&
            std::size_t(bytes_[at_ + 2]) * 256 + bytes_[at_ + 3] == width) {
            at_ += 4;
            for (std::size_t c = 0; c < 4; ++c) read_channel(row, c, width);
        } else {
            read_old_row(row, width);
        }
    }
    void read_channel(std::vector<unsigned char>& row, std::size_t channel, std::size_t width)
    {
        for (std::size_t x = 0; x < width;) {
            std::size_t count = next();
            bool const run = count > 128;
            if (run) count -= 128;
            if (count == 0 || count > width - x) fail("a run is longer than its row");
            unsigned char value = run ? next() : 0;
            for (; count > 0; --count, ++x) row[4 * x + channel] = run ? value : next();
        }
    }
    void read_old_row(std::vector<unsigned char>& row, std::size_t width)
    {
        int shift = 0;
        for (std::size_t x = 0; x < width;) {
            unsigned char pixel[4];
            for (unsigned char& v : pixel) v = next();
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                if (x == 0 || shift > 24) fail("a run has no pixel to repeat");
                std::size_t const count = std::size_t(pixel[3]) << shift;
                if (count > width - x) fail("a run is longer than its row");
                for (std::size_t i = 0; i < count; ++i, ++x) std::memcpy(&row[4 * x], &row[4 * (x - 1)], 4);
                shift += 8;
            } else {
                std::memcpy(&row[4 * x], pixel, 4);
                ++x;
                shift = 0;
            }
        }
    }

    std::span<unsigned char const> bytes_;
    std::string const& name_;
    std::size_t at_ = 0;
    vec3 multiplied_{1};
};

} // namespace

Picture decode_hdr(std::span<unsigned char const> bytes, std::string const& name)
{
    return HdrReader(bytes, name).read();
}

} // namespace gi
