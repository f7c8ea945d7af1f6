#pragma once
// The files that a calibration names: members of a zip archive, or files beside it. Names are relative and stay
// within the archive or folder.

#include "gi/core/error.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace viewer {

class CalibrationFiles {
public:
    /// Throws InputError if the file is no zip archive.
    static CalibrationFiles of_archive(std::filesystem::path const& file);
    static CalibrationFiles of_folder(std::filesystem::path const& folder);

    /// The whole file, unpacked. Throws InputError at `at`: it is missing, damaged, encrypted, leaves the folder, states
    /// more than most_bytes, or all files that were read are larger than 4 GiB.
    std::vector<unsigned char> read(std::string const& name, std::size_t most_bytes,
                                    gi::TextLocation const& at) const;
    /// As in messages: "room.mpcdi/left.pfm".
    std::string full_name(std::string const& name) const;

private:
    struct Archive;
    CalibrationFiles(std::filesystem::path place, std::shared_ptr<Archive> archive);

    std::filesystem::path place_;
    std::shared_ptr<Archive> archive_; ///< null: a folder
};

} // namespace viewer
