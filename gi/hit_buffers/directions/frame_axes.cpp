#include "gi/hit_buffers/directions/frame_axes.h"

#include "gi/core/error.h"
#include "gi/hit_buffers/directions/directions.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

namespace gi {

void FrameAxes::make(AxisSet::Source source, bool walks)
{
    if (set_) earlier_ = {earlier_.built + set_->built(), earlier_.layers + set_->layers(), lost()};
    walks_ = walks;
    dynamic_update_ = {};
    moves_ = source.first_moving < source.soup.count;
    // Streamed axes are built from all triangles in every pass anyway.
    if (slhb_.schedule == Schedule::streamed) source.first_moving = source.soup.count;
    source_.emplace(std::move(source));
    set_.emplace(*source_);
    if (!stored() || !walks_) return;
    StageTimer const timer(report_, "build (hit buffers)");
    until_small_enough([&] { store(); });
}

void FrameAxes::store() { set_->store(make_directions(slhb_.directions)); }

/// Halves the resolution until what a call builds is within --memory.
void FrameAxes::until_small_enough(std::function<void()> const& build)
{
    for (;;) try {
            return build();
        } catch (HitBuffersTooLarge const&) {
            make_smaller();
        }
}

void FrameAxes::make_smaller()
{
    constexpr std::uint32_t kLeast = 8;
    if (source_->resolution < 2 * kLeast)
        throw InputError("even hit buffers of few texels exceed their memory limit",
                         fmt::format("they have {} texels per side, and the limit is {} MiB", source_->resolution,
                                     source_->most_bytes >> 20),
                         "raise --memory, or choose --look-ups none");
    source_->resolution /= 2;
    report_.lose("times the resolution of hit buffers was halved to stay within --memory", 1,
                 fmt::format("now {}", source_->resolution));
    set_.emplace(*source_);
}

void FrameAxes::prepare(int surfaces, std::uint32_t index)
{
    if (!walks_ || (stored() && !moves_)) return;
    auto const sequences = std::uint32_t(std::clamp(surfaces, 1, int(AxisSet::kSequences)));
    StageTimer const timer(report_, stored() ? "layers that moved" : "hit buffers of a pass");
    if (!stored()) {
        return until_small_enough([&] {
            set_->refresh(sequences, std::uint32_t(slhb_.axes), std::uint32_t(slhb_.fresh_axes), index);
            set_->update_axes();
        });
    }
    auto const begun = std::chrono::steady_clock::now();
    std::size_t axes = 0;
    until_small_enough([&] {
        if (set_->tables().axes.empty()) store(); // made smaller, as triangles that moved have more layers
        axes = set_->update_some_axes(sequences, slhb_.gather ? 0 : updated_axes_, frames_);
    });
    double const s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (!std::exchange(follows_, true)) dynamic_update_ = {0, int(axes), int(sequences), 0};
    dynamic_update_.seconds += s;
}

void FrameAxes::end_frame()
{
    follows_ = false;
    ++frames_;
}

void FrameAxes::report_work() const
{
    double const axes = double(earlier_.built + set_->built()), layers = double(earlier_.layers + set_->layers());
    double const texels = double(source_->resolution) * source_->resolution;
    if (walks_) report_.count("levels of hit buffers", double(set_->levels()));
    report_.count("axes built", axes);
    report_.count("layers per texel, mean", axes > 0 ? layers / axes / texels : 0);
}

DynamicUpdate FrameAxes::dynamic_update() const
{
    DynamicUpdate f = dynamic_update_;
    if (walks_ && stored()) f.stored = int(set_->tables().axes.size());
    return f;
}

} // namespace gi
