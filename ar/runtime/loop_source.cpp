#include "ar/runtime/loop_source.h"

#include "ar/capture/clock.h"

#include <algorithm>
#include <stdexcept>

namespace ar {

LoopSource::LoopSource(std::vector<Frame> frames, double rate_hz) : frames_(std::move(frames)), rate_hz_(rate_hz)
{
    if (frames_.empty() || !(rate_hz > 0)) throw std::invalid_argument("a loop without frames or without a rate");
}

std::size_t LoopSource::index_of(std::uint64_t sequence) const
{
    std::uint64_t const last = frames_.size() - 1, k = last > 0 ? sequence % (2 * last) : 0;
    return std::size_t(k <= last ? k : 2 * last - k);
}

std::optional<Frame> LoopSource::next(std::chrono::milliseconds wait)
{
    double const now_s = steady_now_s();
    if (!start_s_) start_s_ = now_s;
    std::uint64_t const number = std::max(next_, std::uint64_t((now_s - *start_s_) * rate_hz_));
    double const captured_s = *start_s_ + double(number) / rate_hz_;
    double const limit_s = now_s + std::chrono::duration<double>(wait).count();
    sleep_until_s(std::min(captured_s, limit_s));
    if (captured_s > limit_s) return std::nullopt;

    Frame f = frames_[index_of(number)];
    f.sequence = number;
    f.captured_s = captured_s;
    f.arrived_s = steady_now_s();
    f.origin = TimestampOrigin::sensor;
    next_ = number + 1;
    tally_.deliver(number);
    return f;
}

SourceDescription LoopSource::description() const
{
    return {.name = "frames read before",
            .id = "loop",
            .size_px = frames_[0].size_px,
            .format = frames_[0].format,
            .frames_per_s = rate_hz_,
            .is_live = true,
            .controls = {}};
}

std::vector<std::string> LoopSource::set(Controls const& controls)
{
    check(controls);
    return cannot_set(controls, "the frames were made before");
}

std::vector<Frame> read_frames(FrameSource& source, int most)
{
    std::vector<Frame> frames;
    while (int(frames.size()) < most) {
        std::optional<Frame> f = source.next(std::chrono::seconds(5));
        if (!f) break;
        frames.push_back(std::move(*f));
    }
    return frames;
}

} // namespace ar
