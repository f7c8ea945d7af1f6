#include "ar/capture/buffer_memory.h"

#include <algorithm>
#include <cerrno>
#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

namespace ar {

int make_memory_file(std::size_t bytes)
{
    int const file = ::memfd_create("lightwell camera", MFD_CLOEXEC);
    if (file < 0) return -1;
    if (::ftruncate(file, off_t(bytes)) == 0) return file;
    ::close(file);
    return -1;
}

BufferMemory::~BufferMemory()
{
    for (Mapping const& m : mappings_) ::munmap(m.at, m.bytes);
}

std::vector<std::span<std::uint8_t const>> BufferMemory::map(std::vector<Plane> const& planes)
{
    std::map<int, std::size_t> bytes_of_file;
    for (Plane const& p : planes) {
        std::size_t& bytes = bytes_of_file[p.file];
        bytes = std::max(bytes, p.offset + p.bytes);
    }
    std::map<int, std::uint8_t const*> start_of_file;
    for (auto const& [file, bytes] : bytes_of_file) {
        void* const at = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
        if (at == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap of a camera's buffer");
        mappings_.push_back({at, bytes});
        start_of_file[file] = static_cast<std::uint8_t const*>(at);
    }
    std::vector<std::span<std::uint8_t const>> mapped;
    for (Plane const& p : planes) mapped.emplace_back(start_of_file[p.file] + p.offset, p.bytes);
    return mapped;
}

void tell_driver(int file, Reading what)
{
    dma_buf_sync sync{DMA_BUF_SYNC_READ |
                      std::uint64_t(what == Reading::begins ? DMA_BUF_SYNC_START : DMA_BUF_SYNC_END)};
    while (::ioctl(file, DMA_BUF_IOCTL_SYNC, &sync) != 0 && (errno == EINTR || errno == EAGAIN)) {
    }
}

} // namespace ar
