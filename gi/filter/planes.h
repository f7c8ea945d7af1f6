#pragma once
// Pictures for filters with wide steps: one plane of floats per channel, with margins on both sides so that a
// loop along a row can read beyond its ends.

#include "gi/core/huge_pages.h"
#include "gi/core/math.h"

#include <algorithm>
#include <memory>
#include <tbb/parallel_for.h>

namespace gi {

/// Three neighbouring planes along one row.
template <class T>
struct Row3 {
    T *x, *y, *z;

    vec3 operator[](int i) const { return {x[i], y[i], z[i]}; }
    void set(int i, vec3 v) const
    {
        x[i] = v.x;
        y[i] = v.y;
        z[i] = v.z;
    }
};

/// Pixel (x, y) of plane p is row(p, y)[x] with x from -kMargin to width + kMargin - 1. Stored row by row, within
/// each row plane by plane. Margins are 0, the rest is uninitialised.
class Planes {
public:
    static constexpr int kMargin = 32;

    Planes(int count, int width, int height)
        : count_(count),
          width_(width),
          height_(height),
          stride_(((std::size_t(width) + 2 * kMargin + 15) / 16 | 1) * 16)
    {
        std::size_t const values = std::size_t(count) * std::size_t(height) * stride_;
        values_.reset(new float[values]);
        advise_huge_pages(values_.get(), values * sizeof(float));
        constexpr int kRows = 16;
        auto const clear_margins = [&](int k) {
            for (int y = k * kRows; y < std::min(height, (k + 1) * kRows); ++y)
                for (int p = 0; p < count; ++p) {
                    std::fill(row(p, y) - kMargin, row(p, y), 0.0f);
                    std::fill(row(p, y) + width, row(p, y) - kMargin + stride_, 0.0f);
                }
        };
        if (height <= kRows)
            clear_margins(0);
        else // first touch of much memory
            tbb::parallel_for(0, (height + kRows - 1) / kRows, clear_margins);
    }
    int count() const { return count_; }
    int width() const { return width_; }
    int height() const { return height_; }
    float* row(int plane, int y) { return values_.get() + offset(plane, y); }
    float const* row(int plane, int y) const { return values_.get() + offset(plane, y); }
    Row3<float> row3(int first, int y) { return {row(first, y), row(first + 1, y), row(first + 2, y)}; }
    Row3<float const> row3(int first, int y) const
    {
        return {row(first, y), row(first + 1, y), row(first + 2, y)};
    }

private:
    std::size_t offset(int plane, int y) const
    {
        return (std::size_t(y) * std::size_t(count_) + std::size_t(plane)) * stride_ + kMargin;
    }

    int count_, width_, height_;
    /// An odd number of cache lines; otherwise all planes would compete for the same few cache sets.
    std::size_t stride_;
    std::unique_ptr<float[]> values_;
};

} // namespace gi
