#pragma once
// Reads the records of an experiment.

#include "study/tables/dataset.h"
#include "study/tables/table.h"

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

/// Calls study::read_dataset and prints its notes on stderr.
study::Dataset load_records(std::string const& dir, std::string const& script);
/// Writes files below `folder`, atomically by renaming; creates missing folders.
void write_files(std::filesystem::path const& folder, std::vector<study::TextFile> const& files);
/// Writes the BIDS tables of all sessions, and the script in code/.
/// @return number of files
int rebuild_tables(std::filesystem::path const& dir, study::Dataset const& records);
/// Samples of gaze of a session, as .tsv.gz and .json (BIDS eye tracking), relative to the data set; none without
/// samples. A missing table or a damaged line is named on stderr and left out.
std::vector<study::TextFile> gaze_files(std::filesystem::path const& dir, study::Script const& script,
                                        study::RecordedSession const& session);

/// Times between swaps of consecutive frames within one stimulus, ms, from all *_frames.csv and *_frames.csv.gz
/// below the folder; incomplete lines are ignored.
std::vector<double> frame_intervals_ms(std::filesystem::path const& dir);

} // namespace viewer
