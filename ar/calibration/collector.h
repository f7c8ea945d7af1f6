#pragma once
// Collects views of a board one after another: which of them add information, which are still missing, and how
// well the lens fits so far.

#include "ar/calibration/lens.h"

namespace ar {

enum class ViewSource {
    stills, ///< each picture is independent
    live,   ///< the board must be held still from one frame to the next
};

struct Offer {
    bool taken = false;
    std::string why;              ///< reason if not taken, worded for the person holding the board
    std::optional<double> rms_px; ///< residual under the calibration so far
};

class Collector {
public:
    /// @param lens model used for the live residuals; @param wanted number of views to collect
    Collector(glm::ivec2 size_px, ViewSource source, LensModel lens = LensModel::radial_tangential,
              int wanted = 15);

    Offer offer(BoardView view);

    std::vector<BoardView> const& views() const { return views_; }
    /// The calibration so far, updated by every accepted view; nothing until there are four views that are not all
    /// parallel (parallel views fit any focal length: Zhang 2000, section 3.1).
    std::optional<LensCalibration> const& live() const { return live_; }
    /// Number of views with points in each cell: 6 x 8, CV_32S.
    cv::Mat coverage() const;
    /// Instruction for the next view, as a sentence; empty if there are enough views.
    std::string next() const;
    bool enough() const { return next().empty(); }

    struct Counts {
        int taken = 0, too_few_points = 0, moving = 0, alike = 0;
    };
    Counts const& counts() const { return counts_; }

private:
    /// The board's position in the picture, size and tilt, each about 0 to 1.
    using Features = std::array<double, 5>;
    Features features_of(BoardView const& view) const;
    bool tilted() const; ///< True if at least two views are tilted relative to each other.

    glm::ivec2 size_px_;
    ViewSource source_;
    LensModel lens_;
    int wanted_;
    std::vector<BoardView> views_;
    std::vector<Features> features_;
    std::optional<BoardView> last_;
    std::optional<LensCalibration> live_;
    Counts counts_;
};

} // namespace ar
