#include "gi/slhb/frame_axes.h"

#include "gi/slhb/settings.h"

#include <algorithm>
#include <chrono>

namespace gi {

void FrameAxes::make(AxisSet::Source source, std::size_t first_moving, bool walks)
{
    if (set_) earlier_ = {built(), layers(), lost()};
    walks_ = walks;
    moves_ = first_moving < source.soup.count;
    // Streamed axes are built in every pass anyway, of all that there is.
    source.first_moving = slhb_.schedule == Schedule::streamed ? source.soup.count : first_moving;
    set_.emplace(source);
    if (!stored() || !walks_) return;
    StageTimer const timer(report_, "build (hit buffers)");
    set_->store(make_directions(slhb_.directions));
}

void FrameAxes::prepare(int surfaces, std::uint32_t index)
{
    if (!walks_ || (stored() && !moves_)) return;
    auto const sequences = std::uint32_t(std::clamp(surfaces, 1, int(AxisSet::kSequences)));
    StageTimer const timer(report_, stored() ? "layers that moved" : "hit buffers of a pass");
    if (!stored()) {
        set_->refresh(sequences, std::uint32_t(slhb_.axes), std::uint32_t(slhb_.fresh_axes), index);
        set_->follow();
        return;
    }
    auto const begun = std::chrono::steady_clock::now();
    std::size_t const axes = set_->follow_some(sequences, slhb_.gather ? 0 : followed_, frames_);
    double const s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (!std::exchange(follows_, true)) following_ = {0, int(axes), int(sequences), 0};
    following_.seconds += s;
}

void FrameAxes::end_frame()
{
    follows_ = false;
    ++frames_;
}

Following FrameAxes::following() const
{
    Following f = following_;
    if (walks_ && stored()) f.stored = int(set_->tables().axes.size());
    return f;
}

} // namespace gi
