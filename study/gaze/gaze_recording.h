#pragma once
// Gaze of one recording, ready to be analysed, and what was shown meanwhile.

#include "study/gaze/clean_gaze.h"
#include "study/tables/dataset.h"

#include <filesystem>

namespace study {

/// A stretch of time in which somebody looked at one picture, or at several side by side.
struct GazeView {
    std::string block, condition; ///< condition: levels of the factors, "cornell, exact"; empty = unknown
    std::string shown;            ///< letters of the stimuli; empty = unknown
    int step = -1;                ///< of the plan, or row of the table of events, from 0
    int attempt = 1;
    bool is_counted = true; ///< as analyses of the answers count it; false: practice, invalid, superseded, ...
    double start_s = 0, end_s = 0; ///< clock of the recording
};

/// Which eyes of two count.
enum class GazeEyes { mean, left, right };

struct GazeRecording {
    std::string name; ///< unique
    std::string participant, source;
    int session = 0;  ///< 0 = unknown
    std::string eyes; ///< left, right, mean of both, as recorded
    /// Its distance is known. Pixels of a headset are those of the plane at its distance.
    ScreenGeometry screen;
    std::pair<double, double> window_px; ///< of sessions: of the window, around the centre of the screen
    std::vector<GazeSample> samples; ///< cleaned, from the centre of the screen
    GazeCounts counts;
    std::vector<GazeView> views; ///< in the order of their times
};

struct GazeRecordings {
    std::vector<GazeRecording> recordings;
    std::vector<std::string> remarks; ///< what is missing or was left out
    std::vector<InputFile> inputs;    ///< files of samples
};

/// Gaze of all sessions that recorded some. A session without the size and distance of its screen is left out with a
/// remark, unless `screen` is given.
/// @param screen  replaces what the sessions recorded   @param exclude  participants
GazeRecordings gaze_of_records(std::filesystem::path const& dir, Dataset const& records,
                               std::optional<ScreenGeometry> const& screen,
                               std::vector<std::string> const& exclude);

/// The same from files: eye tracking in BIDS (physio.tsv.gz or .tsv with its .json files; two eyes of one recording
/// are joined; trials are the rows of the events.tsv beside it), or tables t_s,x_px,y_px (read_gaze_csv), which are
/// one view each.
/// @param screen  replaces what the .json files say; necessary for tables
/// @throws InputError a file cannot be read, has no samples, or its screen is unknown
GazeRecordings gaze_of_files(std::vector<std::filesystem::path> const& files,
                             std::optional<ScreenGeometry> const& screen, GazeEyes eyes);

} // namespace study
