// Any bytes as a recorded session: session.json, the index and the frames' bytes, separated by zeros.
// The result must be frames of the stated sizes or an InputError. The lines of the index get valid checksums,
// otherwise all would be rejected.

#include "ar/capture/session_reader.h"
#include "gi/core/error.h"

#include <cstdlib>
#include <sstream>

namespace {

/// Every line that has a checksum, or ends as one without, gets the right one.
std::string mended(std::string const& index)
{
    std::string out;
    std::istringstream in(index);
    for (std::string line; std::getline(in, line);) {
        bool const has_end = !in.eof();
        if (auto const at = line.rfind(",\"crc32\":\""); at != std::string::npos) line.resize(at);
        out += ar::with_checksum(line) + (has_end ? "\n" : "");
    }
    return out;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const all(reinterpret_cast<char const*>(data), size);
    std::size_t const first = std::min(all.find('\0'), size), second = std::min(all.find('\0', first + 1), size);
    std::string const json = all.substr(0, first),
                      index = all.substr(std::min(first + 1, size), second - std::min(first + 1, second)),
                      bytes = all.substr(std::min(second + 1, size));
    ar::SessionHeader header;
    try {
        header = ar::parse_session_header(json, "fuzz");
        std::string const again = ar::to_json(header);
        if (ar::to_json(ar::parse_session_header(again, "fuzz")) != again) std::abort();
    } catch (gi::InputError const&) {
    }
    for (std::string const& text : {index, mended(index)}) {
        ar::SessionReader reader(header, std::make_unique<std::istringstream>(text),
                                 std::make_unique<std::istringstream>(bytes), bytes.size(), "fuzz");
        std::uint64_t frames = 0;
        while (auto const f = reader.next()) {
            ++frames;
            for (cv::Mat const& m : f->planes)
                if (!m.empty() && cv::sum(m)[0] < 0) std::abort(); // every byte can be read
            ar::IndexEntry entry{.frame = *f};
            entry.bytes = ar::packed_bytes(f->format, f->size_px);
            if (entry.bytes == 0) entry.bytes = f->planes[0].total();
            std::string problem;
            auto const again = ar::parse_index_line(ar::index_line(entry), problem);
            if (!again || again->frame.captured_s != f->captured_s || again->frame.sequence != f->sequence)
                std::abort();
        }
        if (reader.counts().delivered != frames) std::abort();
        (void)reader.end();
    }
    return 0;
}
