#pragma once
// Fuses the poses of successive frames: a multiple hypothesis filter (Reid 1979) whose hypotheses are extended
// Kalman filters of a camera with nearly constant velocity. Where a frame's points fit two poses equally well,
// each hypothesis continues with both; the motion and the fits of the following frames decide between them.
//
// State of a hypothesis: position in the world (m), rotation, velocity in the world (m/s), angular velocity about
// the camera's axes (rad/s); the covariance is 12 x 12 in that order, of the rotation about the camera's axes.
// Measurements are a frame's pose and its mirrored one with their 6 x 6 covariances.

#include "ar/pose/estimate.h"

#include <array>
#include <vector>

namespace ar {

struct FusionSettings {
    double acceleration = 0.2;               ///< spectral density of the acceleration's noise, m^2/s^3: handheld
    double turning = 1;                      ///< likewise of the angular acceleration, rad^2/s^3
    double speed_m_s = 0.5, speed_rad_s = 1; ///< standard deviations of a new track's velocity
    /// Probability densities, per m^3 rad^3, of a pose that has nothing to do with the camera's, and of one that
    /// begins a new track: a clear one may well (frames may be stills), one of two less so.
    double outlier_density = 1e-2, restart_density = 0.2, ambiguous_restart_density = 1e-3;
    /// Weight of a frame's evidence: less than 1, since errors of successive frames are not independent.
    double evidence = 0.5;
    std::size_t hypotheses = 8;   ///< kept at most
    double restart_after_s = 0.5; ///< without an estimate
};

class PoseFusion {
public:
    explicit PoseFusion(FusionSettings const& settings = {}) : settings_(settings) {}

    /// The estimate with pose, covariance and confidence of the most likely hypothesis; `ambiguous` if it was and
    /// others that differ have more than 1 % of the probability. Failed estimates are returned as they are. Call
    /// for every frame, in order; times that do not increase restart the filter.
    PoseEstimate next(double time_s, PoseEstimate const& estimate);

private:
    using Covariance = cv::Matx<double, 12, 12>;
    struct Hypothesis {
        gi::RigidPose pose;
        glm::dvec3 velocity{0}, turning{0};
        Covariance covariance = Covariance::zeros();
        double log_weight = 0;
    };
    struct Measured {
        gi::RigidPose pose;
        cv::Matx66d covariance;
        double log_fit = 0;
    };

    static std::vector<Measured> measured(PoseEstimate const& estimate);
    Hypothesis begun(Measured const& m, double log_weight) const;
    Hypothesis moved(Hypothesis h, double dt_s) const;
    Hypothesis updated(Hypothesis h, Measured const& m) const;
    void prune();

    FusionSettings settings_;
    std::vector<Hypothesis> hypotheses_; ///< the likeliest first, weights of sum 1
    double last_s_ = 0;
};

} // namespace ar
