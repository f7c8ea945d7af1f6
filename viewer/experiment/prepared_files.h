#pragma once
// The folder of a prepared stimulus: its pictures, and stimulus.json with what they are and how long each file is,
// so that a damaged one is noticed before anybody sits down.

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace viewer {

/// Why it cannot be shown, "" = it can. Opens every file, but does not read it.
std::string prepared_flaw(std::filesystem::path const& folder);

/// stimulus.json. Throws InputError where the stimulus is not whole.
nlohmann::json read_prepared(std::filesystem::path const& folder);

/// FOLDER appears whole, in place of one that is not, or not at all.
/// @param write  puts pictures into the folder that it is given, and says what is worth knowing of them
void write_prepared(std::filesystem::path const& folder,
                    std::function<nlohmann::json(std::filesystem::path const& into)> const& write);

} // namespace viewer
