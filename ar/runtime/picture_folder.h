#pragma once
// Writes pictures as numbered files to a folder.

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace viewer {

class PictureFolder {
public:
    /// @throws gi::InputError if the folder cannot be created
    explicit PictureFolder(std::filesystem::path folder);
    /// Writes CV_8UC3 RGB, for example as 000012.png; replaces an existing file. @throws gi::InputError
    void add(std::uint64_t sequence, cv::Mat const& rgb) const;

private:
    std::filesystem::path folder_;
};

} // namespace viewer
