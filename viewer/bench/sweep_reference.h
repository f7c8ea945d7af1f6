#pragma once
// The truth of a sweep: rendered once, kept in its folder, taken from there the next time.

#include "viewer/bench/sweep_plan.h"

namespace viewer {

struct SweepReference {
    gi::Picture picture;
    double relmse = 0;    ///< that its own noise makes; NaN where it has no variance
    std::string png_file; ///< within the folder
};

/// Of a picture that is there already.
SweepReference keep_reference(gi::Picture picture, std::filesystem::path const& folder, std::string const& stem);

/// Which renders count as the same reference, besides scene, camera and settings.
enum class ReferenceOf : std::uint8_t {
    this_program, ///< rendered by this program from this file
    any_program   ///< whichever program rendered it, so that it serves later ones too; it holds L1 as well
};

/// Nothing where it was interrupted; what was traced so far is kept for the next time. Its file's name holds a
/// hash of all that decides its values.
std::optional<SweepReference> find_reference(SweepScene const& scene, gi::RenderSettings settings,
                                             std::uint32_t paths, std::filesystem::path const& folder,
                                             gi::StopRequest const& stop, gi::Report& report,
                                             ReferenceOf valid = ReferenceOf::this_program);

} // namespace viewer
