#pragma once
// The options --poses, --first-pose and --rotation-order of commands that read a session.

#include "ar/scene/camera_poses.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace viewer {

struct PoseArguments {
    std::string file; ///< empty = none
    std::optional<double> first_frame;
    std::string order; ///< of rotations, of Nuke's files; empty = Nuke's default
};

void declare_poses(CLI::App& command, PoseArguments& arguments);
/// --rotation-order alone, for commands that read poses by another option.
void declare_rotation_order(CLI::App& command, std::string& order);

/// @throws gi::InputError an order although none of these files, some of which may be empty, is Nuke's
void check_rotation_order(std::string const& order, std::vector<std::string> const& files);

/// Poses of a file for the session's frames. Says on stderr which number its first frame is taken for, if the file
/// numbers frames and the caller did not say. @throws gi::InputError
std::vector<ar::TimedPose> poses_of(PoseArguments const& arguments, ar::Session const& session,
                                    gi::Report& report);
/// The same of a file of true poses; if it numbers frames, its first pose is the first frame's.
std::vector<ar::TimedPose> true_poses_of(std::string const& file, std::string const& order,
                                         ar::Session const& session, gi::Report& report);

} // namespace viewer
