#pragma once
// Subsets of a picture's pixels, as spans per row.

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

} // namespace gi
