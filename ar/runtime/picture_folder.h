#pragma once
// Pictures as numbered files of a folder.

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace viewer {

class PictureFolder {
public:
    /// @throws gi::InputError it cannot be made
    explicit PictureFolder(std::filesystem::path folder);
    /// CV_8UC3 RGB, as 000012.png; takes the place of one of that number. @throws gi::InputError
    void add(std::uint64_t sequence, cv::Mat const& rgb) const;

private:
    std::filesystem::path folder_;
};

} // namespace viewer
