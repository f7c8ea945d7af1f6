#pragma once
// The recorded path of a head, which bench shown repeats.

#include "viewer/app/user_body.h"
#include "viewer/engine/live/viewpoint.h"

#include <array>
#include <string_view>

namespace viewer {

inline constexpr double kPathEyeHeight_m = 1.6;

/// Names of the paths in data/moving, which are embedded in the program.
std::vector<std::string> head_path_names();

class HeadPath {
public:
    /// @param what  a name, or a CSV file: time_s, then the head relative to the first camera, level: x_m, y_m, z_m
    ///   (right, up, back), yaw_deg, pitch_deg (left, up). Throws InputError if there is none, or too little in it.
    explicit HeadPath(std::string const& what);

    double seconds() const { return samples_.back().time_s; }
    /// Pose at a time, relative to the first camera, level; that of the last sample after the end.
    gi::dmat4 at(double time_s) const;
    bool moves(double time_s) const; ///< then

private:
    struct Sample {
        double time_s = 0;
        std::array<double, 5> pose{}; ///< x, y, z, yaw, pitch
    };
    std::vector<Sample> samples_;
};

/// A head on its path, with eyes and perhaps a body.
class Walker {
public:
    /// @param apart_m  between two eyes; 0: one eye
    Walker(HeadPath path, gi::Camera const& first, double fov_deg, glm::ivec2 size_px, double apart_m,
           std::optional<Stance> const& stance);
    HeadPath const& path() const { return path_; }
    /// What is looked at. @param time_s  on the path  @param step_s  since the last call  @param begun_s  session clock
    Viewpoint at(double time_s, double step_s, double begun_s);

private:
    HeadPath path_;
    gi::Camera camera_;
    gi::dmat4 start_;
    glm::ivec2 size_px_;
    double apart_m_;
    bool has_body_;
    UserBody body_;
};

} // namespace viewer
