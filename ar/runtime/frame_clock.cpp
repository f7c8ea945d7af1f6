#include "ar/runtime/frame_clock.h"

#include <filesystem>

namespace ar {

FrameClock::FrameClock(std::string const& source, SourceDescription const& about, bool is_timed)
    : zero_(about.first), hz_(about.frames_per_s)
{
    bool const is_recording = std::filesystem::exists(std::filesystem::path(source) / "session.json");
    if (!is_timed && !about.is_live && !is_recording) numbered_hz_ = about.frames_per_s;
}

double FrameClock::operator()(Frame const& frame)
{
    auto const apart = [](std::uint64_t to, std::uint64_t from) {
        return to >= from ? double(to - from) : -double(from - to);
    };
    if (!first_) {
        first_ = {frame.sequence, frame.captured_s};
        if (zero_ && hz_ > 0) begins_s_ = apart(frame.sequence, *zero_) / hz_;
    }
    if (numbered_hz_ > 0) return apart(frame.sequence, zero_.value_or(first_->first)) / numbered_hz_;
    return begins_s_ + (frame.captured_s - first_->second);
}

} // namespace ar
