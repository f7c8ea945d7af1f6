#pragma once
// What commands of `lightwell ar` take in common: where frames come from, a printed board, pictures and how long
// each was exposed.

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
    double exposure_ms = 0, gain = 0; ///< 0: as the camera likes
};
void declare_source_arguments(CLI::App& command, SourceArguments& a);
/// Without controls, whose refusals only `FrameSource::set` tells. @throws gi::InputError --size
ar::OpenOptions open_options(SourceArguments const& a, ar::Pace pace, ar::Delivery delivery);
/// Exposure and gain, as asked for.
ar::Controls controls_of(SourceArguments const& a);
/// Opens it and sets its controls; what it cannot set is a line each on stderr. @throws InputError
std::unique_ptr<ar::FrameSource> open(SourceArguments const& a, ar::Pace pace, ar::Delivery delivery);

struct BoardArguments {
    std::string squares, dictionary = "DICT_4X4_50";
    double square_m = 0.04, marker_m = 0.03;
    int first_id = 0;
};
void declare_board_arguments(CLI::App& command, BoardArguments& a);
/// In the origin of the world. @throws InputError naming what is wrong with it
ar::CharucoBoard board_of(BoardArguments const& a);
/// "7x5": whole numbers from 2 to 200. @throws gi::InputError
glm::ivec2 parse_squares(std::string const& option, std::string const& text);

/// CV_8UC3, RGB. @throws InputError not there, not whole, no picture
cv::Mat read_rgb(std::string const& file);
/// "1/30,1/60,0.004": seconds, each above 0. @throws gi::InputError
std::vector<double> parse_exposures(std::string const& text);

} // namespace viewer
