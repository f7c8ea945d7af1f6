#pragma once
// Shared memory that a camera writes and the program reads: the driver's (dma-buf), or an anonymous file.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace ar {

/// Creates an anonymous file in memory; the caller closes it. @return negative on failure (see errno)
int make_memory_file(std::size_t bytes);

/// Maps the planes of a camera's buffers for reading, for the lifetime of this object.
class BufferMemory {
public:
    struct Plane {
        int file = -1;
        std::size_t offset = 0, bytes = 0;
    };

    BufferMemory() = default;
    ~BufferMemory();
    BufferMemory(BufferMemory const&) = delete;
    BufferMemory& operator=(BufferMemory const&) = delete;

    /// Maps the planes of one buffer, which may share a file.
    /// @throws std::system_error if mapping fails
    std::vector<std::span<std::uint8_t const>> map(std::vector<Plane> const& planes);

private:
    struct Mapping {
        void* at = nullptr;
        std::size_t bytes = 0;
    };
    std::vector<Mapping> mappings_;
};

/// Notifies the driver that the CPU begins or ends reading (dma-buf); does nothing for other files.
enum class Reading { begins, ends };
void tell_driver(int file, Reading what);

} // namespace ar
