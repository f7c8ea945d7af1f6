#pragma once
// Recorded poses as text, and a tracker that plays them back.
//
//   time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,buttons,visible
//   0.000,head,0,1.7,2,0,0,0,1,0,1
//
// The first line names the columns; buttons and visible are optional columns. Times must not decrease. Lines that
// are empty or begin with # are skipped.

#include "viewer/devices/tracking/tracker.h"

#include <filesystem>
#include <string_view>

namespace viewer {

/// @param file  name for messages. Throws InputError with file:line:column.
std::vector<TrackerSample> parse_tracker_file(std::string_view text, std::string const& file);
std::string format_tracker_file(std::vector<TrackerSample> const& samples);
/// Throws InputError.
std::vector<TrackerSample> read_tracker_file(std::filesystem::path const& file);

enum class AtEnd { stop, begin_again };

/// Plays samples by the clock passed to poll, times speed; playback starts at the first poll.
class FileTracker : public Tracker {
public:
    /// @param samples  sorted by measured_s, which all must have
    FileTracker(std::vector<TrackerSample> samples, std::string name, AtEnd at_end = AtEnd::stop,
                double speed = 1);

    void poll(double now_s, std::vector<TrackerSample>& samples) override;
    TrackerCounts counts() const override { return counts_; }
    std::string description() const override { return "file " + name_; }
    bool at_end() const { return next_ == samples_.size(); }

private:
    std::vector<TrackerSample> samples_;
    std::string name_;
    AtEnd at_end_;
    double speed_;
    std::optional<double> start_s_; ///< steady clock when the first sample is due
    std::size_t next_ = 0;
    TrackerCounts counts_;
};

} // namespace viewer
