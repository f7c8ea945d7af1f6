#pragma once
// Which pixels a filter has to compute and which it reads for that:
// only few if most light is already known from a partner.

#include "gi/filter/reused_light.h"

#include <span>
#include <vector>

namespace gi {

/// Pixels first..end - 1 of a row.
struct Span {
    int first, end;
};
/// Spans of one row, from left to right, neither adjacent nor overlapping.
using Spans = std::span<Span const>;
/// Spans of every row of a picture.
using RowSpans = std::vector<std::vector<Span>>;

/// Calls `call` for the parts of `within` that are outside all `holes`, from left to right.
template <class F>
void for_between(Spans within, Spans holes, F const& call)
{
    auto hole = holes.begin();
    for (Span const& s : within) {
        int from = s.first;
        for (; hole != holes.end() && hole->first < s.end; ++hole) {
            if (hole->first > from) call(Span{from, hole->first});
            from = hole->end;
        }
        if (from < s.end) call(Span{from, s.end});
    }
}

/// Returns the spans dilated by `reach` pixels in x and y, clipped to `width`.
RowSpans widened(RowSpans const& rows, int reach, int width);

struct FilterArea {
    RowSpans wanted; ///< pixels that a filter has to compute
    RowSpans near;   ///< `wanted` and all pixels that the filter reads: at least one pixel around

    /// True if all light that is near but not wanted is the partner's; the filter does not report on those pixels.
    bool takes = false;

    /// Calls `call` for every span of row y that is in `near` but not in `wanted`.
    template <class F>
    void for_known(int y, F const& call) const
    {
        for_between(near[std::size_t(y)], wanted[std::size_t(y)], call);
    }
};

/// Area in which all surfaces are wanted: in each row, from the first to the last surface pixel.
FilterArea whole_area(Picture const& picture);

/// Area in which only surfaces that take no valid light from the partner are wanted.
/// The pictures may differ in size.
/// @param reach  radius of the filter, pixels; if at least the picture's size, every pixel is near
FilterArea own_area(Picture const& picture, ReusedLight const& taken, int reach);

} // namespace gi
