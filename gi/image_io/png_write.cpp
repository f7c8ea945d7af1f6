#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <fstream>
#include <png.h>
#include <stdexcept>
#include <zlib.h>

namespace gi {
namespace {

[[noreturn]] void fail(png_structp, png_const_charp why) { throw std::runtime_error(why); }

void write(png_structp png, png_bytep bytes, std::size_t size)
{
    static_cast<std::ofstream*>(png_get_io_ptr(png))
        ->write(reinterpret_cast<char const*>(bytes), std::streamsize(size));
}

/// Compresses as fast as OpenCV does: a difference to the left, and runs of equal bytes.
class PngWriter {
public:
    PngWriter(std::ofstream& out, int width, int height, bool has_alpha)
        : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, [](png_structp, png_const_charp) {})),
          info_(png_create_info_struct(png_)),
          row_bytes_(std::size_t(width) * (has_alpha ? 4 : 3))
    {
        png_set_write_fn(png_, &out, write, [](png_structp) {});
        png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
        png_set_compression_level(png_, Z_BEST_SPEED);
        png_set_compression_strategy(png_, Z_RLE);
        png_set_IHDR(png_, info_, png_uint_32(width), png_uint_32(height), 8,
                     has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_write_info(png_, info_);
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(PngWriter const&) = delete;
    PngWriter& operator=(PngWriter const&) = delete;

    void add(std::span<unsigned char const> rows)
    {
        for (std::size_t at = 0; at < rows.size(); at += row_bytes_) png_write_row(png_, rows.data() + at);
    }
    void end() { png_write_end(png_, info_); }

private:
    png_structp png_;
    png_infop info_;
    std::size_t row_bytes_;
};

} // namespace

void write_png(std::filesystem::path const& file, int width, int height,
               std::function<std::vector<unsigned char>(int first, int count)> const& rows)
{
    write_by_rename(file, [&](std::filesystem::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.exceptions(std::ios::failbit | std::ios::badbit);
        std::vector<unsigned char> some = rows(0, std::min(kRowsAtOnce, height));
        std::size_t const pixels = std::size_t(width) * std::size_t(std::min(kRowsAtOnce, height));
        PngWriter png(out, width, height, some.size() == 4 * pixels);
        png.add(some);
        for (int y = kRowsAtOnce; y < height; y += kRowsAtOnce)
            png.add(rows(y, std::min(kRowsAtOnce, height - y)));
        png.end();
        out.flush();
    });
}

void write_png(std::filesystem::path const& file, int width, int height, std::span<unsigned char const> bytes)
{
    std::size_t const row = bytes.size() / std::size_t(height);
    write_png(file, width, height, [&](int first, int count) {
        auto const some = bytes.subspan(row * std::size_t(first), row * std::size_t(count));
        return std::vector<unsigned char>(some.begin(), some.end());
    });
}

} // namespace gi
