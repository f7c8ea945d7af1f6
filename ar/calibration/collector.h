#pragma once
// Views of a board one after another: which of them add something, what is still missing, and how well it fits so
// far.

#include "ar/calibration/lens.h"

namespace ar {

enum class ViewSource {
    stills, ///< every picture is on its own
    live,   ///< the board must be held still from one frame to the next
};

struct Offer {
    bool taken = false;
    std::string why;              ///< not taken: in words for who holds the board
    std::optional<double> rms_px; ///< residual under the calibration so far
};

class Collector {
public:
    /// @param lens for the live residuals; @param wanted views
    Collector(glm::ivec2 size_px, ViewSource source, LensModel lens = LensModel::radial_tangential,
              int wanted = 15);

    Offer offer(BoardView view);

    std::vector<BoardView> const& views() const { return views_; }
    /// The calibration so far, from four views on that are not all parallel (those fit any focal length: Zhang
    /// 2000, section 3.1); renewed by every view that is taken.
    std::optional<LensCalibration> const& live() const { return live_; }
    /// Views with points in each cell: 6 x 8, CV_32S.
    cv::Mat coverage() const;
    /// What to show next, as a sentence; empty: it is enough.
    std::string next() const;
    bool enough() const { return next().empty(); }

    struct Counts {
        int taken = 0, too_few_points = 0, moving = 0, alike = 0;
    };
    Counts const& counts() const { return counts_; }

private:
    /// Where the board is in the picture, how large and how tilted, each about 0 to 1.
    using Features = std::array<double, 5>;
    Features features_of(BoardView const& view) const;
    bool tilted() const; ///< two views at least, against each other

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
