#pragma once
// Arguments shared by the commands of `lightwell ar`: frame sources, printed boards,
// pictures and their exposure times.

#include "ar/capture/open_source.h"
#include "ar/markers/marker_map.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace viewer {

struct SourceArguments {
    std::string source, size = "640x480", format;
    double rate_hz = 30;
    double exposure_ms = 0, gain = 0; ///< 0: automatic
};
void declare_source_arguments(CLI::App& command, SourceArguments& a);
/// Options to open the source, without its controls (`FrameSource::set` reports those that the source refuses).
/// @throws gi::InputError on an invalid --size
ar::OpenOptions open_options(SourceArguments const& a, ar::Pace pace, ar::Delivery delivery);
/// The requested exposure and gain.
ar::Controls controls_of(SourceArguments const& a);
/// Opens the source and sets its controls; prints a line on stderr for each that cannot be set. @throws InputError
std::unique_ptr<ar::FrameSource> open(SourceArguments const& a, ar::Pace pace, ar::Delivery delivery);

struct BoardArguments {
    std::string squares, dictionary = "DICT_4X4_50";
    double square_m = 0.04, marker_m = 0.03;
    int first_id = 0;
    bool legacy_pattern = false;
};
void declare_board_arguments(CLI::App& command, BoardArguments& a);
/// The board, placed at the origin of the world. @throws InputError if its values are invalid
ar::CharucoBoard board_of(BoardArguments const& a);
/// Says doubts about a map (ar/markers/map_doubts.h) on stderr. @param where  its file, or the options
void say_doubts(ar::MarkerMap const& map, std::string const& where);
/// Parses "7x5": whole numbers from 2 to 200. @throws gi::InputError
glm::ivec2 parse_squares(std::string const& option, std::string const& text);

/// Reads a picture as CV_8UC3, RGB. @throws InputError if it is missing, incomplete or not a picture
cv::Mat read_rgb(std::string const& file);
/// Parses "1/30,1/60,0.004": seconds, each > 0. @throws gi::InputError
std::vector<double> parse_exposures(std::string const& text);

} // namespace viewer
