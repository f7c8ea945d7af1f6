#pragma once
// Gaze from an eye tracker by the Lab Streaming Layer (LSL).

#include "viewer/experiment/gaze/gaze_source.h"

namespace viewer {

/// Which channels of a stream are what; -1 = none.
struct GazeChannels {
    int x = -1, y = -1;             ///< of both eyes or one
    int other_x = -1, other_y = -1; ///< of the other eye; gaze is the mean of both, or the valid one
    int pupil = -1, valid = -1;
    bool is_normalised = true; ///< 0..1 over the monitor; else its pixels
};

/// By the labels of the channels, as eye trackers' streams name them: gaze_x, x, left_gaze_x, right_gaze_x,
/// left_gaze_point_on_display_area_0, ..., pupil_diameter, validity. Units: px and pixels, else normalised.
/// @return none if there is no pair of x and y
std::optional<GazeChannels> gaze_channels(std::vector<std::string> labels, std::vector<std::string> const& units);

/// A sample of these channels, in px of the monitor (or window, if the monitor is unknown) from the window's
/// centre. NaN and validity 0 make it invalid; one valid eye of two is enough.
study::GazeSample gaze_sample(GazeChannels const& channels, std::vector<double> const& values, double time_s,
                              GazePlace const& place);

/// Any stream of type Gaze. @param name  empty = the first one. Throws InputError as open_gaze.
std::unique_ptr<GazeSource> open_lsl_gaze(std::string const& name);

} // namespace viewer
