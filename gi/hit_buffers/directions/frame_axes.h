#pragma once
// Keeps the axes of a renderer between frames, according to its schedule: stored axes, of which all or some are
// updated for dynamic geometry, or axes drawn for each pass.

#include "gi/core/report.h"
#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/settings.h"
#include "gi/render/frame_renderer.h"

#include <functional>
#include <optional>

namespace gi {

class FrameAxes {
public:
    /// @param settings, report  must outlive this object
    FrameAxes(SlhbSettings const& settings, Report& report) : slhb_(settings), report_(report) {}

    /// Makes the axes; call this first. Stored axes are built here.
    /// @param walks  true if paths may leave a surface along an axis; else no axis is built
    void make(AxisSet::Source source, bool walks);
    /// Prepares the axes of a pass. @param surfaces  number of surfaces that a path may leave along an axis
    void prepare(int surfaces, std::uint32_t index);
    void end_frame();

    /// See SlhbRenderer.
    void update_axes(std::uint32_t axes) { updated_axes_ = axes; }
    DynamicUpdate dynamic_update() const;

    bool walks() const { return walks_; }
    AxisSet& set() { return *set_; }
    AxisSet const& set() const { return *set_; }
    /// Number of layers beyond a texel's limit so far, including earlier sets.
    std::uint64_t lost() const { return earlier_.lost + set_->lost(); }
    /// Reports the work done so far, including earlier sets.
    void report_work() const;

private:
    bool stored() const { return slhb_.schedule == Schedule::stored; }

    SlhbSettings const& slhb_;
    Report& report_;
    /// Rebuilds with fewer texels if the buffers take too much memory.
    void store();
    void until_small_enough(std::function<void()> const& build);
    void make_smaller();

    std::optional<AxisSet::Source> source_;
    std::optional<AxisSet> set_;
    bool walks_ = false, moves_ = false;          ///< moves_: some geometry may move
    std::uint32_t updated_axes_ = 0, frames_ = 0; ///< axes updated per bounce, 0 = all; frames so far
    DynamicUpdate dynamic_update_;                ///< in this frame
    bool follows_ = false;                        ///< axes were updated in this frame
    struct {
        std::uint64_t built = 0, layers = 0, lost = 0;
    } earlier_;
};

} // namespace gi
