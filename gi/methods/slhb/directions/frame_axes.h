#pragma once
// The axes of a renderer from frame to frame, as its schedule says: stored ones, of which all or some follow what
// moves, or those that each pass draws.

#include "gi/core/report.h"
#include "gi/methods/slhb/directions/axis_set.h"
#include "gi/render/frame_renderer.h"

#include <optional>

namespace gi {

class FrameAxes {
public:
    /// @param settings, report  outlive this
    FrameAxes(SlhbSettings const& settings, Report& report) : slhb_(settings), report_(report) {}

    /// Anew, before all else; stored ones are built here.
    /// @param walks  paths may leave a surface along an axis: else none is built
    void make(AxisSet::Source source, bool walks);
    /// Those of a pass. @param surfaces  of a path that it may leave along an axis
    void prepare(int surfaces, std::uint32_t index);
    void end_frame();

    /// See SlhbRenderer.
    void update_axes(std::uint32_t axes) { updated_axes_ = axes; }
    DynamicUpdate dynamic_update() const;

    bool walks() const { return walks_; }
    AxisSet& set() { return *set_; }
    AxisSet const& set() const { return *set_; }
    /// Layers beyond the limit of a texel, so far, of sets that are no more as well.
    std::uint64_t lost() const { return earlier_.lost + set_->lost(); }
    /// What has been built so far, likewise.
    void report_work() const;

private:
    bool stored() const { return slhb_.schedule == Schedule::stored; }

    SlhbSettings const& slhb_;
    Report& report_;
    /// With fewer texels, where the buffers would take too much memory.
    void make_smaller();

    std::optional<AxisSet::Source> source_;
    std::optional<AxisSet> set_;
    bool walks_ = false, moves_ = false;          ///< something may move
    std::uint32_t updated_axes_ = 0, frames_ = 0; ///< axes of a bounce, 0 = all; so far
    DynamicUpdate dynamic_update_;                ///< in this frame
    bool follows_ = false;                        ///< and it has in this frame
    struct {
        std::uint64_t built = 0, layers = 0, lost = 0;
    } earlier_;
};

} // namespace gi
