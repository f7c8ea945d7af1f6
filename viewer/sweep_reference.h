#pragma once
// The truth of a sweep: rendered once, kept in its folder, taken from there the next time.

#include "viewer/sweep_plan.h"

namespace viewer {

struct SweepReference {
    gi::Picture picture;
    double relmse = 0;    ///< that its own noise makes; NaN where it has no variance
    std::string png_file; ///< within the folder
};

/// Of a picture that is there already.
SweepReference keep_reference(gi::Picture picture, std::filesystem::path const& folder, std::string const& stem);

/// Nothing where it was interrupted; what was traced so far is kept for the next time. Its file's name holds a
/// hash of all that decides its values, the program included.
std::optional<SweepReference> find_reference(SweepScene const& scene, gi::RenderSettings settings,
                                             std::uint32_t paths, std::filesystem::path const& folder,
                                             gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
