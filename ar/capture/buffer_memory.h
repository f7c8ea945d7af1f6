#pragma once
// Memory that a camera writes and others read: of the driver (dma-buf), or a file without a name.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace ar {

/// A file in memory without a name, to be closed by the caller. @return below 0 where that failed (errno)
int make_memory_file(std::size_t bytes);

/// The planes of a camera's buffers, mapped for reading until the end of this.
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

    /// Of one buffer; its planes may share a file.
    /// @throws std::system_error it cannot be mapped
    std::vector<std::span<std::uint8_t const>> map(std::vector<Plane> const& planes);

private:
    struct Mapping {
        void* at = nullptr;
        std::size_t bytes = 0;
    };
    std::vector<Mapping> mappings_;
};

/// Tells the driver that the CPU begins or ends reading (dma-buf); nothing for other files.
enum class Reading { begins, ends };
void tell_driver(int file, Reading what);

} // namespace ar
