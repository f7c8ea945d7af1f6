#pragma once
// Facts of BIDS files in their JSON sidecars, which files inherit from folders above them (BIDS, Common principles,
// The inheritance principle).

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace study {

/// The name of a BIDS file, taken apart: "sub-01_task-view_recording-eye1_physio.tsv.gz".
struct BidsName {
    std::vector<std::string> entities;              ///< "sub-01", "task-view", in their order
    std::string suffix;                             ///< "physio"
    std::string entity(std::string_view key) const; ///< "01" of "sub"; empty = none
};
BidsName bids_name(std::filesystem::path const& file);

/// Facts of the JSON files of this suffix that apply to a file: those in its folder and the folders above, up to that
/// of dataset_description.json, whose entities are all among the file's. Nearer and more specific ones count.
/// @throws gi::InputError a file is no JSON object
nlohmann::json bids_facts(std::filesystem::path const& file, std::string const& suffix);

} // namespace study
