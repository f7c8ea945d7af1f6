#include "gi/core/rng.h"
#include "gi/filter/filter_area.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

std::vector<std::vector<bool>> pixels_of(RowSpans const& rows, int width)
{
    std::vector<std::vector<bool>> in(rows.size(), std::vector<bool>(std::size_t(width)));
    for (std::size_t y = 0; y < rows.size(); ++y)
        for (Span const& s : rows[y])
            for (int x = s.first; x < s.end; ++x) in[y][std::size_t(x)] = true;
    return in;
}

RowSpans some_spans(std::uint64_t seed, int width, int height)
{
    Pcg32 rng(seed, 1);
    RowSpans rows{std::size_t(height)};
    for (auto& row : rows)
        for (int x = 0; x < width; ++x)
            if (rng.uniform() < 0.03f) {
                if (!row.empty() && row.back().end == x)
                    ++row.back().end;
                else
                    row.push_back({x, x + 1});
            }
    return rows;
}

TEST(Spans, WidenedReachAsFarAsTold)
{
    constexpr int kWidth = 41, kHeight = 19;
    for (int const reach : {0, 1, 4, 100}) {
        RowSpans const rows = some_spans(5, kWidth, kHeight), wide = widened(rows, reach, kWidth);
        auto const in = pixels_of(rows, kWidth), out = pixels_of(wide, kWidth);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                bool near = false;
                for (int j = std::max(0, y - reach); j <= std::min(kHeight - 1, y + reach); ++j)
                    for (int i = std::max(0, x - reach); i <= std::min(kWidth - 1, x + reach); ++i)
                        near = near || in[std::size_t(j)][std::size_t(i)];
                ASSERT_EQ(out[std::size_t(y)][std::size_t(x)], near) << reach << ": " << x << ", " << y;
            }
        for (auto const& row : wide)
            for (std::size_t k = 1; k < row.size(); ++k) EXPECT_GT(row[k].first, row[k - 1].end);
    }
    EXPECT_TRUE(widened({}, 3, 10).empty());
}

TEST(Spans, WhatIsKnownIsNearButNotWanted)
{
    FilterArea const area{{{{3, 5}, {7, 8}, {20, 22}}}, {{{0, 10}, {20, 25}, {30, 31}}}};
    std::vector<std::pair<int, int>> known;
    area.for_known(0, [&](Span s) { known.emplace_back(s.first, s.end); });
    EXPECT_EQ(known, (std::vector<std::pair<int, int>>{{0, 3}, {5, 7}, {8, 10}, {22, 25}, {30, 31}}));
}

} // namespace
} // namespace gi::test
