#pragma once
// Some of a picture's pixels, row by row.

#include <span>
#include <vector>

namespace gi {

/// Pixels first..end - 1 of a row.
struct Span {
    int first, end;
};
/// Of one row, from left to right; they neither meet nor overlap.
using Spans = std::span<Span const>;
/// Of each row of a picture.
using RowSpans = std::vector<std::vector<Span>>;

/// Calls for every span that lies within some and in none of the holes, from left to right.
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

/// With pixels up to `reach` in x and in y from them, in rows of `width`.
RowSpans widened(RowSpans const& rows, int reach, int width);

} // namespace gi
