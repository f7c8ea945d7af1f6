#pragma once
// Selects evenly spaced frames from a stream of unknown length: every n-th is kept, and n doubles when twice as
// many as wanted have been kept.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace ar {

template <class T>
class SpacedFrames {
public:
    explicit SpacedFrames(std::size_t wanted) : wanted_(wanted) {}

    /// True if `add` would keep the next frame; if not, call `skip` instead.
    bool wants_next() const { return seen_ % step_ == 0; }
    void skip() { ++seen_; }
    void add(T value)
    {
        kept_.push_back(std::move(value));
        ++seen_;
        if (kept_.size() < 2 * wanted_) return;
        for (std::size_t i = 0; i < wanted_; ++i) kept_[i] = std::move(kept_[2 * i]);
        kept_.resize(wanted_);
        step_ *= 2;
    }
    /// Returns at most the wanted number, from first to last.
    std::vector<T> take()
    {
        std::vector<T> out;
        std::size_t const n = std::min(wanted_, kept_.size());
        for (std::size_t i = 0; i < n; ++i)
            out.push_back(std::move(kept_[n > 1 ? i * (kept_.size() - 1) / (n - 1) : 0]));
        return out;
    }

private:
    std::size_t wanted_;
    std::vector<T> kept_;
    std::uint64_t seen_ = 0, step_ = 1;
};

} // namespace ar
