// Any bytes as the state of an unfinished render: it is taken up or refused with an InputError. The fingerprint,
// the size and the checksum are made right, since chance never would.

#include "gi/core/error.h"
#include "gi/core/xxhash.h"
#include "gi/render/checkpoint.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <unistd.h>
#include <vector>

namespace {

/// @param bytes  no fewer than a state of 2 x 2 pixels without further paths
void make_checksum_right(std::vector<unsigned char>& bytes)
{
    auto const header = std::size_t(gi::checkpoint_bytes(0, 0)), means = std::size_t(gi::checkpoint_bytes(2, 2));
    std::memset(&bytes[header - sizeof(std::uint64_t)], 0, sizeof(std::uint64_t));
    std::span<std::byte const> const all = std::as_bytes(std::span(bytes));
    std::uint64_t hash = gi::xxh64(all.first(header));
    hash = gi::xxh64(all.subspan(header, means - header), hash);
    hash = gi::xxh64(all.subspan(means), hash);
    std::memcpy(&bytes[header - sizeof hash], &hash, sizeof hash);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    constexpr std::uint64_t kPrint = 12;
    std::vector<unsigned char> bytes(data, data + size);
    if (size > 16 && data[size - 1] % 2 == 0) std::memcpy(&bytes[8], &kPrint, sizeof kPrint);
    if (size > 16 && data[size - 1] % 4 == 0) {
        bytes.resize(std::size_t(gi::checkpoint_bytes(2, 2)));
        if (data[size - 1] % 8 == 0) { // further paths, which the last word but one of the header tells of
            bytes[std::size_t(gi::checkpoint_bytes(0, 0)) - 2 * sizeof(std::uint64_t)] = 1;
            bytes.resize(bytes.size() + 4 * sizeof(std::uint32_t), data[0]);
        }
        make_checksum_right(bytes);
    }
    std::filesystem::path const file =
        std::filesystem::temp_directory_path() / ("state_fuzz_" + std::to_string(getpid()));
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(bytes.data()), std::streamsize(bytes.size()));
    gi::Accumulator sums(2, 2);
    try {
        if (!gi::load_checkpoint(file, sums, kPrint) || sums.pixels.size() != 4 ||
            (!sums.further.empty() && sums.further.size() != 4))
            std::abort();
    } catch (gi::InputError const&) {
    }
    std::filesystem::remove(file);
    return 0;
}
