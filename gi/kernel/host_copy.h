#pragma once
// Reads a buffer of either space on the host again and again, in memory that is kept and page-locked: copying to
// fresh memory takes several times as long.

#include "gi/kernel/buffer.h"
#include "gi/kernel/device_memory.h"

#include <memory>
#include <span>

namespace gi {

template <class T, Space S>
class HostCopy {
public:
    /// The buffer's items, until the next call or until the buffer changes.
    std::span<T const> of(Buffer<T, S> const& buffer)
    {
        if constexpr (S == Space::host) {
            return {buffer.view().data, buffer.size()};
        } else {
            std::size_t const bytes = buffer.size() * sizeof(T);
            if (size_ < buffer.size()) {
                items_.reset(); // before the new ones
                items_.reset(static_cast<T*>(device::allocate_page_locked(bytes)));
                size_ = buffer.size();
            }
            copy_bytes(Space::host, items_.get(), S, buffer.view().data, bytes);
            return {items_.get(), buffer.size()};
        }
    }

private:
    struct Release {
        void operator()(T* items) const { device::release_page_locked(items); }
    };
    std::unique_ptr<T, Release> items_;
    std::size_t size_ = 0;
};

} // namespace gi
