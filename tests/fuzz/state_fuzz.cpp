// Any bytes as the state of an unfinished render: it is taken up or refused with an InputError. The fingerprint
// and the size are made right, since chance never would.

#include "gi/core/error.h"
#include "gi/render/checkpoint.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <unistd.h>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    constexpr std::uint64_t kPrint = 12;
    std::vector<unsigned char> bytes(data, data + size);
    if (size > 16 && data[size - 1] % 2 == 0) std::memcpy(&bytes[8], &kPrint, sizeof kPrint);
    if (size > 16 && data[size - 1] % 4 == 0) {
        bytes.resize(std::size_t(gi::checkpoint_bytes(2, 2)));
        if (data[size - 1] % 8 == 0) { // further paths, which the last word of the header tells of
            bytes[std::size_t(gi::checkpoint_bytes(0, 0)) - sizeof(std::uint64_t)] = 1;
            bytes.resize(bytes.size() + 4 * sizeof(std::uint32_t), data[0]);
        }
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
