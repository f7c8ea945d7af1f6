#pragma once
// The manifest of a batch (YAML, schema batch/2; batch/1 is of version 0.1): groups of tasks, made from command lines with {parameters}.
// docs/batch.md describes every key.

#include "gi/core/mistakes.h"
#include "viewer/batch/task.h"

#include <filesystem>
#include <map>

namespace viewer::batch {

struct ReadManifest {
    Batch batch; ///< its program and keys are still missing (give_keys)
    gi::Mistakes mistakes;
};

/// @param text      of the manifest  @param file  its name, for messages; inputs are relative to its folder
/// @param commands  of lightwell that tasks may call
ReadManifest read_manifest(std::string const& text, std::string const& file,
                           std::vector<std::string> const& commands);

/// Finds the input files of tasks and hashes them.
class InputFinder {
public:
    /// @param folder that relative names are relative to
    InputFinder(Batch& batch, std::filesystem::path folder) : batch_(batch), folder_(std::move(folder)) {}
    /// Indices of a file, or of all files in a folder. @throws InputError there is none
    std::vector<int> find(std::string const& name);

private:
    int index_of(std::string const& name, std::filesystem::path const& path);

    Batch& batch_;
    std::filesystem::path folder_;
    std::map<std::string, int> known_; ///< indices by name
};

} // namespace viewer::batch
