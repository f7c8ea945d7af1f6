#pragma once
// The response of one channel of frames with more than 8 bits, with the interface of ResponseTable: from code to
// unit and back to the code with the nearest unit.

#include "ar/camera/photometry.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace ar {

/// Codes of 16 bits.
class DeepResponse {
public:
    using Code = std::uint16_t;
    static constexpr Code kWhite = 65535;

    DeepResponse() = default;
    explicit DeepResponse(std::array<float, 256> const& unit_of_byte) : units_(units_of_16_bits(unit_of_byte)) {}

    float unit(Code code) const { return (*units_)[code]; }
    /// The code with the nearest unit; the lower one on ties. NaN: 0.
    Code code(float unit) const
    {
        std::vector<float> const& u = *units_;
        if (!(unit > u.front())) return 0;
        if (unit >= u.back()) return kWhite;
        auto const above = std::upper_bound(u.begin(), u.end(), unit); // in (begin, end)
        auto const below = std::lower_bound(u.begin(), above, *(above - 1));
        return Code((unit - *below <= *above - unit ? below : above) - u.begin());
    }
    /// The camera's own code if it is a nearest one, else as `code`.
    Code code_near(float unit, Code camera) const
    {
        Code const nearest = code(unit);
        return (*units_)[nearest] == (*units_)[camera] ? camera : nearest;
    }

private:
    std::shared_ptr<std::vector<float> const> units_;
};

/// Float frames of radiance: nothing is clipped or rounded.
class LinearResponse {
public:
    using Code = float;
    static constexpr Code kWhite = std::numeric_limits<float>::infinity();

    explicit LinearResponse(float radiance_per_unit = 1) : radiance_per_unit_(radiance_per_unit) {}
    float unit(Code radiance) const { return radiance / radiance_per_unit_; }
    Code code(float unit) const { return unit * radiance_per_unit_; }
    Code code_near(float unit, Code) const { return code(unit); }

private:
    float radiance_per_unit_ = 1;
};

} // namespace ar
