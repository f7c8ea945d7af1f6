#pragma once
// A recorded head, and what is asked of the bench.

#include "viewer/app/user_body.h"
#include "viewer/engine/live/viewpoint.h"

#include <filesystem>

namespace viewer {

namespace fs = std::filesystem;

struct Options {
    std::string scene, head, avatar, truth_filter = "oidn-high";
    fs::path out, truth;
    int truth_paths = 128, width = 640, height = 480, eyes = 1, scored = 8, young = 0, paths = 1;
    double fov_deg = 60, offline_hz = 0, light_scale = 0.25, surface_scale = 1, late_s = 0, drawn_scale = 1;
    std::vector<Change> settings;
};

struct HeadSample {
    double time_s = 0;
    std::array<double, 5> pose{}; ///< x, y, z, yaw, pitch
};

inline constexpr double kEyeHeight_m = 1.6;

class Walk {
public:
    /// The options must outlive this object.
    Walk(Options const& o, gi::Camera const& first, std::optional<Stance> const& stance);
    double seconds() const { return samples_.back().time_s; }
    void begin(double s) { begun_s = s; } ///< session clock
    Viewpoint at(double time_s, double step_s);
    bool moves(double time_s) const; ///< the head, then

private:
    Options const& o_;
    std::vector<HeadSample> samples_;
    gi::Camera first_;
    gi::dmat4 start_;
    bool has_body_;
    UserBody body_;
    double begun_s = 0;
};

} // namespace viewer
