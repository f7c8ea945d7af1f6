#include "gi/filter/spans.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <utility>

namespace gi {

RowSpans widened(RowSpans const& rows, int reach, int width)
{
    int const height = int(rows.size());
    RowSpans wide(rows.size());
    tbb::parallel_for(0, height, [&](int y) {
        thread_local std::vector<int> begun; // per pixel: number of spans that begin minus number that end there
        begun.assign(std::size_t(width) + 1, 0);
        for (int there = std::max(0, y - reach); there <= std::min(height - 1, y + reach); ++there)
            for (Span const& s : rows[std::size_t(there)]) {
                ++begun[std::size_t(std::max(0, s.first - reach))];
                --begun[std::size_t(std::min(width, s.end + reach))];
            }
        int inside = 0;
        for (int x = 0; x <= width; ++x) {
            int const before = std::exchange(inside, inside + begun[std::size_t(x)]);
            if (before == 0 && inside > 0) wide[std::size_t(y)].push_back({x, width});
            if (before > 0 && inside == 0) wide[std::size_t(y)].back().end = x;
        }
    });
    return wide;
}

} // namespace gi
