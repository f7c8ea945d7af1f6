#pragma once
// A stop request that comes at a certain ask, and whose clock counts asks: with it, tests of interruption measure
// how much work is done after a request. Time tells that on a quiet machine only.

#include "gi/core/progress.h"

#include <atomic>
#include <cstdint>
#include <tbb/global_control.h>

namespace gi::test {

class StopAtAsk : public StopRequest {
public:
    static constexpr std::uint64_t kNoAsk = std::uint64_t(1) << 40;
    /// @param ask  at which it is requested, unless request() is called before
    /// @param duration  of an ask by its clock. The usual one is so long that nothing goes on for a first picture
    /// (BuildStop); with none, first pictures are always completed.
    explicit StopAtAsk(std::uint64_t ask = kNoAsk, std::chrono::nanoseconds duration = std::chrono::seconds(1))
        : ask_(ask), duration_(duration)
    {
    }
    std::uint64_t asks() const { return asks_; }
    std::uint64_t ask() const { return ask_; }
    /// At that many asks from now, unless that was called before.
    void request_after(std::uint64_t more)
    {
        std::uint64_t none = kNoAsk;
        ask_.compare_exchange_strong(none, asks_ + more);
    }
    std::chrono::nanoseconds now() const override { return duration_ * std::int64_t(asks_); }

private:
    std::chrono::nanoseconds requested_at() const override
    {
        return ++asks_ >= ask_ ? duration_ * std::int64_t(ask_) : StopRequest::requested_at();
    }

    std::atomic<std::uint64_t> ask_;
    std::chrono::nanoseconds duration_;
    mutable std::atomic<std::uint64_t> asks_ = 0;
};

/// The most asks after a request until all threads have noticed it: each asks once or twice more.
inline std::uint64_t asks_until_noticed()
{
    return 4 * tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

} // namespace gi::test
