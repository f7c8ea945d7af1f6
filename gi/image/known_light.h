#pragma once
// Pixels whose filtered light is known before a filter starts, and those that it has to find.

#include "gi/image/filter_input.h"
#include "gi/image/taken_light.h"

#include <optional>
#include <vector>

namespace gi {

/// Pixels first..end - 1 of a row.
struct Span {
    int first, end;
};
/// Of one row, from left to right.
using Spans = std::span<Span const>;

struct KnownLight {
    std::vector<std::vector<Span>> wanted; ///< per row: what a filter has to find
    /// Direct and indirect light as in namespace light, where nothing is wanted; without it, that stays as it is.
    std::optional<Planes> light;
    int width = 0;

    /// Calls for every span of a row that is not wanted.
    template <class F>
    void for_known(int y, F const& call) const
    {
        int from = 0;
        for (Span const& s : wanted[std::size_t(y)]) {
            if (s.first > from) call(Span{from, s.first});
            from = s.end;
        }
        if (from < width) call(Span{from, width});
    }
};

/// Nothing is known: from the first to the last surface of each row is wanted.
KnownLight nothing_known(FilterInput const& input);

/// The partner's filtered light over its albedo, where the picture takes it and both have a surface to go by.
/// Sizes may differ.
KnownLight known_from(Picture const& picture, FilterInput const& input, TakenLight const& taken);

} // namespace gi
