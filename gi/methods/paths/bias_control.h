#pragma once
// Measures how far light by look-ups and shadow maps is from that of exact rays, while a picture is rendered: in every pass some paths are traced
// again by look-ups and by exact rays, along the same axes, to the same light points and with the same random numbers. So most pairs are equal, and the
// differences of the others have little noise.

#include "gi/core/report.h"
#include "gi/render/look_up_bias.h"

#include <array>
#include <cstddef>
#include <optional>

namespace gi {

class BiasControl {
public:
    /// Sums of a pass's radiance over paths traced both ways, and over channels.
    struct PassLight {
        std::array<double, 2> looked_up{}, exact{}; ///< direct, indirect
        std::uint64_t paths = 0;
    };

    /// @return of each how many pixels one is traced both ways
    static std::size_t stride(std::size_t pixels);
    void add(PassLight const& pass);
    /// Ratios of sums over passes (which share no axes and light points, unless those are stored); nothing from fewer than three passes. Infinite
    /// where exact rays have no light.
    std::optional<LookUpBias> bias() const;

private:
    struct Moments {
        double difference = 0, exact = 0, difference2 = 0, exact2 = 0, product = 0;
    };
    Deviation deviation(Moments const& m) const;
    double all_light() const { return parts_[0].exact + parts_[1].exact; }

    std::array<Moments, 2> parts_;
    std::uint64_t passes_ = 0, paths_ = 0;
};

/// Reports a loss if direct or indirect light is wrong by more than one per cent of its own, beyond doubt, and by more than a thousandth of all.
void report_bias(std::optional<LookUpBias> const& bias, Report& report);

} // namespace gi
