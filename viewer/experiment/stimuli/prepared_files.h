#pragma once
// The folder of a prepared stimulus: its pictures, and stimulus.json with their description and the length of each
// file, so that damage is detected before a session begins.

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace viewer {

/// Reason why the stimulus cannot be shown, "" if it can. Opens every file without reading all of it.
std::string prepared_flaw(std::filesystem::path const& folder);

/// Reads stimulus.json. Throws InputError if the stimulus is incomplete.
nlohmann::json read_prepared(std::filesystem::path const& folder);

/// Writes FOLDER, which appears whole or not at all, and replaces an incomplete one.
/// @param write  writes pictures into the given folder, and returns their description
void write_prepared(std::filesystem::path const& folder,
                    std::function<nlohmann::json(std::filesystem::path const& into)> const& write);

} // namespace viewer
