#pragma once
// Buffer<T, S> owns an array in memory space S; View borrows it. New buffers are uninitialised; debug builds fill
// them with 0xFF bytes, which give NaN floats and invalid indices.

#include "gi/core/view.h"
#include "gi/kernel/device.h"

#include <stdexcept>
#include <utility>

namespace gi {

template <class T, Space S>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Buffer() = default;
    /// @param n number of items. Throws std::bad_alloc or std::runtime_error without enough memory or a device.
    explicit Buffer(std::size_t n) : count_(n)
    {
        if (n == 0) return;
        if (n > std::size_t(-1) / sizeof(T)) throw std::bad_alloc();
        items_ = static_cast<T*>(allocate_bytes(S, n * sizeof(T)));
#ifndef NDEBUG
        fill_bytes(S, items_, 0xFF, n * sizeof(T));
#endif
    }
    ~Buffer()
    {
        if (items_ != nullptr) free_bytes(S, items_);
    }
    Buffer(Buffer&& other) noexcept
        : items_(std::exchange(other.items_, nullptr)), count_(std::exchange(other.count_, 0))
    {
    }
    Buffer& operator=(Buffer&& other) noexcept
    {
        std::swap(items_, other.items_);
        std::swap(count_, other.count_);
        return *this;
    }

    std::size_t size() const { return count_; }
    View<T> view() { return {items_, count_}; }
    View<T const> view() const { return {items_, count_}; }

private:
    T* items_ = nullptr;
    std::size_t count_ = 0;
};

/// Copies all items between any two spaces; both buffers must have the same length.
template <class T, Space To, Space From>
void copy(Buffer<T, From> const& from, Buffer<T, To>& to)
{
    if (from.size() != to.size()) throw std::logic_error("buffers of unequal size cannot be copied");
    copy_bytes(To, to.view().data, From, from.view().data, from.size() * sizeof(T));
}

template <Space S, class T>
Buffer<T, S> upload(std::vector<T> const& values)
{
    Buffer<T, S> buffer(values.size());
    copy_bytes(S, buffer.view().data, Space::host, values.data(), values.size() * sizeof(T));
    return buffer;
}

template <class T, Space S>
std::vector<T> download(Buffer<T, S> const& buffer)
{
    std::vector<T> values(buffer.size());
    copy_bytes(Space::host, values.data(), S, buffer.view().data, values.size() * sizeof(T));
    return values;
}

} // namespace gi
