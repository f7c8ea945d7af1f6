#pragma once
// Structs in columns: the first word of all items, then the second of all, and so on. Threads of a device that
// step together then read neighbouring words, and what a kernel does not use of an item is not read.

#include "gi/kernel/buffer.h"

#include <array>
#include <cstdint>

namespace gi {

template <class T>
struct ColumnView {
    using Words = std::array<std::uint32_t, sizeof(T) / sizeof(std::uint32_t)>;
    static_assert(sizeof(Words) == sizeof(T), "structs in columns consist of words of 4 bytes");

    View<std::uint32_t> words;
    std::size_t count = 0;

    GI_FN T load(std::size_t i) const
    {
        Words item;
        for (std::size_t k = 0; k < item.size(); ++k) item[k] = words[k * count + i];
        return __builtin_bit_cast(T, item); // std::bit_cast of a T that is no literal type is a host function
    }
    GI_FN void store(std::size_t i, T const& value) const
    {
        Words const item = __builtin_bit_cast(Words, value);
        for (std::size_t k = 0; k < item.size(); ++k) words[k * count + i] = item[k];
    }
    /// Changes one word of an item.
    GI_FN void set_word(std::size_t i, std::size_t word, std::uint32_t value) const
    {
        words[word * count + i] = value;
    }
};

/// Owns `count` uninitialised items.
template <class T, Space S>
class ColumnBuffer {
public:
    ColumnBuffer() = default;
    explicit ColumnBuffer(std::size_t count) : words_(count * (sizeof(T) / sizeof(std::uint32_t))), count_(count)
    {
    }

    std::size_t size() const { return count_; }
    Buffer<std::uint32_t, S>& words() { return words_; } ///< column after column
    ColumnView<T> view() { return {words_.view(), count_}; }

private:
    Buffer<std::uint32_t, S> words_;
    std::size_t count_ = 0;
};

} // namespace gi
