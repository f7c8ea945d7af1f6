#include "ar/runtime/frame_clock.h"

#include <filesystem>

namespace ar {

FrameClock::FrameClock(std::string const& source, SourceDescription const& about, bool is_timed)
{
    bool const is_recording = std::filesystem::exists(std::filesystem::path(source) / "session.json");
    if (!is_timed && !about.is_live && !is_recording) numbered_hz_ = about.frames_per_s;
}

double FrameClock::operator()(Frame const& frame)
{
    if (!first_) first_ = {frame.sequence, frame.captured_s};
    return numbered_hz_ > 0 ? double(frame.sequence - first_->first) / numbered_hz_
                            : frame.captured_s - first_->second;
}

} // namespace ar
