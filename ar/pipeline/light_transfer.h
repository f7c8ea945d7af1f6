#pragma once
// How much of the light from each direction arrives at points of the real surfaces: exact rays for what is in the
// way, and one radiosity solution for light by way of other surfaces. All surfaces count as matt.

#include "ar/light/light_fit.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/shading/shading_point.h"

namespace ar {

/// A point of a surface that light is computed for.
struct ReceivingPoint {
    gi::vec3 position{0}; ///< in the world, less World::origin
    gi::vec3 normal{0}, geometric_normal{0};
    float clearance = 0; ///< m; at which rays start
};
ReceivingPoint receiving_point(gi::ShadingPoint const& p);

class LightTransfer {
public:
    /// @param world  must outlive this object and not change
    LightTransfer(gi::World const& world, LightBasis const& basis);

    /// V n.w dw of each point and direction: points x directions, CV_32F, sr.
    cv::Mat direct(std::vector<ReceivingPoint> const& points) const;
    /// Light by way of other surfaces, all bounces, per channel, in the same form.
    std::array<cv::Mat, 3> by_surfaces(std::vector<ReceivingPoint> const& points) const;
    /// V n.w, the mean over a disc of light.
    std::vector<float> of_disc(std::vector<ReceivingPoint> const& points, glm::dvec3 towards,
                               double half_angle_rad) const;

    gi::ExactVisibility const& visibility() const { return visibility_; }

private:
    /// A surface point that represents those hit by rays nearby, and the albedo there.
    struct MetPlace {
        int place;
        gi::vec3 albedo;
    };
    struct FoundHit {
        ReceivingPoint point;
        gi::vec3 albedo;
    };
    std::vector<std::vector<FoundHit>> look_around(std::vector<ReceivingPoint> const& points,
                                                   std::uint32_t seed) const;
    static std::vector<std::vector<MetPlace>> by_places(std::vector<std::vector<FoundHit>> const& hits,
                                                        std::vector<ReceivingPoint> const& places);

    gi::World const& world_;
    gi::WorldView view_;
    LightBasis const& basis_;
    gi::ExactVisibility visibility_;
};

} // namespace ar
