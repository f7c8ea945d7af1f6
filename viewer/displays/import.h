#pragma once
// Import of display files from other programs. Settings without an equivalent here, and values that had to be
// assumed, are counted in the report by name; nothing is dropped silently.
//
// Corners, frame and units of each format:
// - SGCT, JSON and the older XML: lowerleft, upperleft, upperright; our frame, m. Fisheye, cylindrical and
//   equirectangular projections become surfaces, spherical mirrors four walls of a cube with meshes.
// - ParaView .pvx: LowerLeft, LowerRight, UpperRight (or UpperLeft); our frame, taken as m.
// - Equalizer .eqc: bottom_left, bottom_right, top_left; our frame, m.
// - Vrui .cfg: origin, horizontalAxis, verticalAxis, width, height; forwardDirection becomes -Z, upDirection +Y;
//   inchScale or meterScale. Patch files need the configuration that they change.
// - nDisplay .ndisplay (JSON, cm) and its older .cfg (m): x forward, y to the right, z up;
//   screens by centre and size.
// - Calibrations of projectors: calibration.h.
//
// Viewports of SGCT and Equalizer count from the window's lower left corner, ours from the top left corner.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace viewer {

enum class DisplayFormat { yaml, sgct, pvx, equalizer, vrui, ndisplay, mpcdi, vioso };
char const* name_of(DisplayFormat format);
/// Format by file extension: .yaml or .yml, .json, .xml, .pvx, .eqc, .cfg, .ndisplay, .mpcdi, .vwf; of .xml by its
/// first element. Throws InputError for others.
DisplayFormat format_of(std::filesystem::path const& file);

/// Something in a file that has no equivalent here, or that had to be assumed.
struct SkippedPart {
    std::string what, where; ///< where: "file:line:column"
};

/// A map or picture that the display file names.
struct KeptFile {
    std::string name; ///< path as the display file writes it
    std::vector<unsigned char> bytes;
};

/// Counts in a report, and lists, what an importer could not take over.
class ImportLog {
public:
    /// @param prefix  of the names of kept files: a folder beside the display file, and a slash
    ImportLog(gi::Report& report, std::string prefix = {}) : report_(&report), prefix_(std::move(prefix)) {}
    void lose(std::string const& what, std::uint64_t count, std::string const& where) const;
    std::vector<SkippedPart> const& parts() const { return *parts_; } ///< the first 10,000
    gi::Report& report() const { return *report_; }
    /// Keeps a file under the prefix and `name`, or another name if it is taken; returns what the display file calls it.
    std::string keep_file(std::string const& name, std::vector<unsigned char> bytes) const;
    void keep_only(std::set<std::string> const& names) const;
    std::vector<KeptFile> const& files() const { return *files_; } ///< to be written beside the display file

private:
    gi::Report* report_;
    std::string prefix_;
    std::shared_ptr<std::vector<SkippedPart>> parts_ = std::make_shared<std::vector<SkippedPart>>();
    std::shared_ptr<std::vector<KeptFile>> files_ = std::make_shared<std::vector<KeptFile>>();
};

/// Each throws InputError, with file:line:column if known, if the text is not of the format or the display is
/// invalid. Meshes of SGCT are read from the folder of `name`.
Display parse_sgct(std::string const& text, std::string const& name, ImportLog log);
Display parse_sgct_xml(std::string const& text, std::string const& name, ImportLog log);
Display parse_pvx(std::string const& text, std::string const& name, ImportLog log);
Display parse_equalizer(std::string const& text, std::string const& name, ImportLog log);
Display parse_ndisplay(std::string const& text, std::string const& name, ImportLog log);
Display parse_ndisplay_cfg(std::string const& text, std::string const& name, ImportLog log);

/// A file of Vrui.
struct VruiText {
    std::string text, name;
};
/// `section` names the environment within "section Vrui"; empty = the first with screens. Later files change what
/// earlier ones say, as with -mergeConfig.
Display parse_vrui(std::vector<VruiText> const& files, std::string const& section, ImportLog log);
Display parse_vrui(std::string const& text, std::string const& name, std::string const& section, ImportLog log);

struct ImportOptions {
    std::string section{};             ///< Vrui
    std::filesystem::path base_file{}; ///< Vrui: configuration that the file changes; empty = none
};
/// Imports any format, including ours, by file extension. The log has what was skipped, and the files to write.
Display import_display(std::filesystem::path const& file, ImportOptions const& options, ImportLog const& log);

} // namespace viewer
