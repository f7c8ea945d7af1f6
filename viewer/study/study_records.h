#pragma once
// The records of an experiment, for the commands that read them.

#include "study/tables/dataset.h"
#include "study/tables/table.h"

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

/// As study::read_dataset; what there is to say of it goes to stderr.
study::Dataset load_records(std::string const& dir, std::string const& script);
/// Below `folder`, each by rename, folders made where they are missing.
void write_files(std::filesystem::path const& folder, std::vector<study::TextFile> const& files);
/// BIDS tables of all sessions, and the script beside them in code/.
/// @return how many files
int rebuild_tables(std::filesystem::path const& dir, study::Dataset const& records);

/// Times between the swaps of neighbouring frames within one stimulus, ms, of all *_frames.csv and *_frames.csv.gz
/// below the folder; lines that are not whole are passed over.
std::vector<double> frame_intervals_ms(std::filesystem::path const& dir);

} // namespace viewer
