#pragma once
// Takes samples from a source of gaze, writes them beside the journal, and passes them to who waits for them.

#include "viewer/experiment/gaze/gaze_source.h"

#include <filesystem>
#include <optional>

namespace viewer {

class GazeRecorder {
public:
    /// @param source  may be null: there is no gaze   @param folder, stem  of the session; the table is
    ///     STEM_part-01_gaze.csv, with the first number that is free: each part of a session has its own
    GazeRecorder(std::unique_ptr<GazeSource> source, std::filesystem::path folder, std::string const& stem);

    bool is_open() const { return source_ != nullptr; }
    /// Takes what has come. Never blocks.
    void poll(GazePlace const& place, double now_s);
    /// Watches get every further sample; null = none.
    void watch(study::GazeWatch* watch) { watch_ = watch; }
    /// Step of the plan and letters of the visible stimuli, for the rows that follow.
    void at(int step, std::string const& shown);
    /// The last sample that was valid and is not older than 0.2 s.
    std::optional<study::GazeSample> latest(double now_s) const;
    /// Keeps further samples until end_capture() returns them.
    void begin_capture() { captured_.emplace(); }
    std::vector<study::GazeSample> end_capture();

    /// Appends the rows to the table. Throws InputError if it cannot be written; the rows are kept.
    void flush();
    /// Facts for the records; gaze_table is the name of the file.
    std::vector<std::pair<std::string, std::string>> about() const;

private:
    std::unique_ptr<GazeSource> source_;
    std::filesystem::path file_;
    std::string rows_, shown_ = "-";
    int step_ = -1;
    study::GazeWatch* watch_ = nullptr;
    std::optional<study::GazeSample> latest_;
    std::optional<std::vector<study::GazeSample>> captured_;
};

} // namespace viewer
