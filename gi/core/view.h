#pragma once
// View<T>: non-owning pointer + size of a contiguous array, bounds-checked in debug builds on host and device.

#include "gi/core/platform.h"

#include <cassert>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace gi {

template <class T>
struct View {
    T* data = nullptr;
    std::size_t count = 0;

    View() = default;
    GI_FN View(T* first, std::size_t n) : data(first), count(n) {}
    template <class U>
    requires std::is_same_v<std::remove_const_t<T>, U> View(std::vector<U> const& v)
    requires std::is_const_v<T> : data(v.data()), count(v.size()) {}
    View(std::vector<std::remove_const_t<T>>& v) : data(v.data()), count(v.size()) {}

    GI_FN T& operator[](std::size_t i) const
    {
        assert(i < count);
        return data[i];
    }
    GI_FN std::size_t size() const { return count; }
    GI_FN bool empty() const { return count == 0; }
    GI_FN T* begin() const { return data; }
    GI_FN T* end() const { return data + count; }
};

} // namespace gi
