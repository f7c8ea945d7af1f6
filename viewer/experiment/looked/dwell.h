#pragma once
// How long gaze was on what, with the error that the eye tracker's accuracy leaves.
//
// A fixation is spread over several rays, the same offsets for all fixations of a recording: errors of accuracy are
// those of its calibration, so that all fixations share them. Each offset gives a dwell; their mean is the estimate,
// and their standard deviation its error. Errors of different recordings are independent.

#include <map>
#include <string>
#include <vector>

namespace viewer {

struct DwellTarget {
    std::string kind, name; ///< object, material, none
    auto operator<=>(DwellTarget const&) const = default;
};

struct DwellOn {
    double seconds = 0, se = 0;
    double by_mirror_s = 0; ///< of it, by way of mirrors and panes
};

/// Of one recording.
class Dwell {
public:
    explicit Dwell(std::size_t offsets) : offsets_(offsets) {}
    /// The ray of one offset was on this for so long. @param seconds  of the fixation
    void add(DwellTarget const& target, std::size_t offset, double seconds, bool is_by_mirror);
    void add(Dwell const& other);
    std::map<DwellTarget, DwellOn> all() const;

private:
    struct Sums {
        std::vector<double> seconds; ///< by offset
        double by_mirror = 0;        ///< of all offsets
    };
    std::size_t offsets_;
    std::map<DwellTarget, Sums> on_;
};

} // namespace viewer
