#pragma once
// Projector calibrations of other programs: what each projector's pixels show, and how bright.

#include "viewer/displays/calibration_files.h"
#include "viewer/displays/import.h"

namespace viewer {

/// A projector.
struct CalibratedProjector {
    Wall wall; ///< corners or surface, maps and pictures; without a window and a user
    glm::ivec2 size_px{0};
    gi::dvec3 eye_m{0}; ///< for whom it was calibrated, in the room
    gi::TextLocation at;
};

/// VESA Multiple Projection Common Data Interchange 1.0 and 2.0: mpcdi.xml. Profiles:
/// - 2d: a flat picture; the warp file (PFM) says where in a region's part of it each pixel takes its colour.
/// - 3d: a picture in the frustum of one eye, and where in it each pixel takes its colour.
/// - a3: the warp file says which point each pixel lights: x right, y up, z backward.
/// - sl: as a3, with the projector's pose. Without a warp file: the picture from there, bent by the distortion map.
/// A warp file in a unit of length has points, whatever the profile. Yaw turns right, pitch upward, roll clockwise, each
/// about the axes that `coordinateFrame` gives (yaw down, pitch right, roll forward). Regions count from the upper left.
/// Alpha maps are factors on light, beta maps the light of black.
/// Sources: the MPCDI library's reader (rows of PFM from below, enumerations), Christie's notes (frames and
/// angles), Unreal's nDisplay (axes of points; NaN and (0, 0, 0) are none).
/// Throws InputError with the line on what is no such calibration. Maps are kept in the log.
/// @param only  id of the one region that is read; empty = all
std::vector<CalibratedProjector> read_mpcdi(std::string const& xml, std::string const& name,
                                            CalibrationFiles const& files, ImportLog const& log,
                                            std::string const& only = {});
/// The archive's mpcdi.xml, or the text of a file of that name. @param name  becomes the XML's name in messages
std::string mpcdi_text(CalibrationFiles const& archive, std::filesystem::path const& file, std::string& name);

/// VIOSO's .vwf (the headers and the reader of VIOSO's API): mappings of 32-bit floats, rows from above, with points
/// (x right, y up, z backward) or with positions in a picture from its upper left corner, and a bitmap of blend
/// factors. Throws InputError on compressed, encrypted and damaged files. Maps are kept in the log.
/// @param unit_m  of points, m: the file does not state it; VIOSO measures in millimetres
/// @param only  number of the one mapping whose maps are read; none = all
std::vector<CalibratedProjector> read_vioso(std::span<unsigned char const> bytes, std::string const& name,
                                            double unit_m, ImportLog const& log,
                                            std::optional<std::size_t> only = {});
inline constexpr double kViosoUnit_m = 0.001;

/// Each projector in a window of its own, side by side, one user per eye place. Throws as finished().
Display display_of(std::vector<CalibratedProjector> projectors, std::string const& file, ImportLog const& log);

} // namespace viewer
