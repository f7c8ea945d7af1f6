#include "gi/core/gzip.h"

#include "gi/core/error.h"

#include <algorithm>
#include <climits>
#include <memory>
#include <stdexcept>
#include <zlib.h>

namespace gi {
namespace {

constexpr int kGzipFormat = 15 + 16;

} // namespace

std::string gzip(std::string_view text)
{
    z_stream stream{};
    constexpr int kMemory = 8;
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipFormat, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib does not start");
    std::string packed(deflateBound(&stream, uLong(text.size())) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    int const end = deflate(&stream, Z_FINISH);
    packed.resize(packed.size() - stream.avail_out);
    deflateEnd(&stream);
    if (end != Z_STREAM_END) throw std::runtime_error("zlib does not end");
    return packed;
}

std::string gunzip(std::string_view bytes, std::string const& file, std::size_t max_bytes)
{
    auto const wrong = [&](char const* why) {
        return InputError("'" + file + "' cannot be unpacked", why, "pack the table again with gzip");
    };
    z_stream stream{};
    if (inflateInit2(&stream, kGzipFormat) != Z_OK) throw std::runtime_error("zlib does not start");
    std::unique_ptr<z_stream, int (*)(z_stream*)> const ends(&stream, inflateEnd);
    std::string text, buffer(std::size_t(1) << 16, '\0');
    std::size_t given = 0;
    bool is_whole = false;
    while (true) {
        if (stream.avail_in == 0 && given < bytes.size()) {
            std::size_t const n = std::min(bytes.size() - given, std::size_t(1) << 30);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + given));
            stream.avail_in = uInt(n);
            given += n;
        }
        if (is_whole) { // further members follow
            if (stream.avail_in == 0) return text;
            inflateReset(&stream);
        }
        stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
        stream.avail_out = uInt(buffer.size());
        int const state = inflate(&stream, Z_NO_FLUSH);
        text.append(buffer, 0, buffer.size() - stream.avail_out);
        if (text.size() > max_bytes) throw wrong("its text is too long");
        is_whole = state == Z_STREAM_END;
        if (state == Z_BUF_ERROR ||
            (state == Z_OK && stream.avail_in == 0 && given == bytes.size() && stream.avail_out > 0))
            throw wrong("it is cut off");
        if (state != Z_OK && !is_whole) throw wrong("it is no gzip file, or damaged");
    }
}

} // namespace gi
