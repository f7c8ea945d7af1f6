// Any bytes as a recording: frames and an end, or an InputError.
// Checksums are made right, since chance never would.

#include "gi/core/crc32.h"
#include "gi/core/error.h"
#include "viewer/protocol/recording/recording.h"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace {

void mend_checksums(std::vector<std::uint8_t>& bytes)
{
    for (std::size_t at = 12; at + 9 <= bytes.size();) {
        std::uint32_t length = 0;
        std::memcpy(&length, &bytes[at], 4);
        if (length > bytes.size() - at - 9) return;
        std::uint32_t const sum = gi::crc32(std::span(bytes).subspan(at, 5 + length));
        std::memcpy(&bytes[at + 5 + length], &sum, 4);
        at += 9 + length;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::vector<std::uint8_t> bytes(data, data + size);
    if (size > 0 && data[size - 1] % 4 != 0) mend_checksums(bytes);
    try {
        viewer::RecordingReader reader(
            std::make_unique<std::istringstream>(std::string(bytes.begin(), bytes.end())), bytes.size(), "fuzz");
        std::uint64_t frames = 0;
        while (reader.next()) ++frames;
        if (reader.end().frames != frames || reader.end().unread_bytes > size) std::abort();
    } catch (gi::InputError const&) {
    }
    return 0;
}
