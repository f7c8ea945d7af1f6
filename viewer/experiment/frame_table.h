#pragma once
// Times of swaps and viewpoints: rows are kept in memory while stimuli are shown,
// and appended to two files between trials.

#include "viewer/devices/gl/swap_timer.h"
#include "viewer/protocol/frame_command.h"

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

struct FrameRow {
    int step = 0, attempt = 1; ///< in the plan
    std::string shown;         ///< letters of the visible stimuli; "-" = none
    double swap_s = 0;         ///< steady clock
    double uncertainty_ms = 0;
    char const* method = "";
    double render_ms = 0; ///< of the newest picture shown
    int dropped = 0;      ///< refreshes before it without a new picture
};
struct PoseRow {
    double time_s = 0;
    gi::dvec3 position{0};          ///< m, world
    gi::dquat rotation{1, 0, 0, 0}; ///< world from camera
};

class FrameTable {
public:
    /// Appends to FOLDER/STEM_frames.csv and _poses.csv, which are created with their first row.
    FrameTable(std::filesystem::path folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem))
    {
    }

    void add(FrameRow row) { frames_.push_back(std::move(row)); }
    void add(PoseRow const& row) { poses_.push_back(row); }
    /// Throws InputError if the files cannot be written; the rows are kept.
    void flush();
    /// Replaces both .csv files by .csv.gz, appending to existing .csv.gz files.
    void compress();

private:
    std::filesystem::path folder_;
    std::string stem_;
    std::vector<FrameRow> frames_;
    std::vector<PoseRow> poses_;
};

} // namespace viewer
