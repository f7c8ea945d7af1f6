#pragma once
// Reference pictures of a sweep: rendered once, then kept in its folder and read from there.

#include "viewer/bench/sweep_plan.h"

namespace viewer {

struct SweepReference {
    gi::Picture picture;
    double relmse = 0;    ///< caused by its own noise; NaN if it has no variance
    std::string png_file; ///< file name within the folder
};

/// Makes a reference from an existing picture and saves its PNG.
SweepReference keep_reference(gi::Picture picture, std::filesystem::path const& folder, std::string const& stem);

/// Which existing renders are used as a reference, if scene, camera and settings are equal.
enum class ReferenceOf : std::uint8_t {
    this_program, ///< only those rendered by this version of the program from this file
    any_program   ///< by any version, so that later versions can use it too; also contains L1
};

/// Reads or renders the reference. Returns nothing if interrupted; the paths so far are kept for the next call.
/// The file name contains a hash of everything that determines the picture.
std::optional<SweepReference> find_reference(SweepScene const& scene, gi::RenderSettings settings,
                                             std::uint32_t paths, std::filesystem::path const& folder,
                                             gi::StopRequest const& stop, gi::Report& report,
                                             ReferenceOf valid = ReferenceOf::this_program);

} // namespace viewer
