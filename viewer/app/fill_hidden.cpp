#include "viewer/app/fill_hidden.h"

#include <algorithm>
#include <optional>

namespace viewer {
namespace {

/// Fills one row. Returns false if all of it is hidden.
bool fill_row(std::span<std::uint8_t const> hidden, std::span<float> values, std::size_t channels)
{
    std::size_t const width = hidden.size();
    auto const copy = [&](std::size_t from, std::size_t to) {
        std::copy_n(&values[from * channels], channels, &values[to * channels]);
    };
    bool any = false;
    for (std::size_t begin = 0, end = 0; begin < width; begin = end) {
        end = begin;
        while (end < width && (hidden[end] != 0) == (hidden[begin] != 0)) ++end;
        if (hidden[begin] == 0) {
            any = true;
            continue;
        }
        if (begin == 0 && end == width) return false;
        std::size_t const middle = begin == 0 ? begin : end == width ? end : (begin + end) / 2;
        for (std::size_t x = begin; x < end; ++x) copy(x < middle ? begin - 1 : end, x);
    }
    return any;
}

} // namespace

void fill_hidden(std::span<std::uint8_t const> hidden, int width, std::span<float> values, int channels)
{
    if (hidden.empty()) return;
    std::size_t const across = std::size_t(width), rows = hidden.size() / across,
                      stride = across * std::size_t(channels);
    auto const copy_row = [&](std::size_t from, std::size_t to) {
        std::copy_n(&values[from * stride], stride, &values[to * stride]);
    };
    std::optional<std::size_t> last;
    for (std::size_t y = 0; y < rows; ++y) {
        bool const seen = fill_row(hidden.subspan(y * across, across), values.subspan(y * stride, stride),
                                   std::size_t(channels));
        if (seen) {
            // Hidden rows in between: copy the upper half from above, the lower half from this row.
            std::size_t const first = last ? *last + 1 : 0, middle = last ? (*last + 1 + y) / 2 : 0;
            for (std::size_t r = first; r < y; ++r) copy_row(r < middle ? *last : y, r);
            last = y;
        }
    }
    if (last)
        for (std::size_t r = *last + 1; r < rows; ++r) copy_row(*last, r);
}

} // namespace viewer
