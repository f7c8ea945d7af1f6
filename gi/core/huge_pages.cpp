#include "gi/core/huge_pages.h"

#include <cstdint>
#include <sys/mman.h>

namespace gi {

void advise_huge_pages(void* first, std::size_t bytes)
{
    constexpr std::uintptr_t kPage = 2u << 20;
    auto const begin = reinterpret_cast<std::uintptr_t>(first), end = begin + bytes;
    std::uintptr_t const low = (begin + kPage - 1) / kPage * kPage, high = end / kPage * kPage;
    if (low < high) madvise(reinterpret_cast<void*>(low), high - low, MADV_HUGEPAGE); // a failure only costs speed
}

} // namespace gi
