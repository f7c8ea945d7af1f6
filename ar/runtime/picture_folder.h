#pragma once
// Writes pictures as numbered files to a folder.

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace ar {

class PictureFolder {
public:
    /// @throws gi::InputError if the folder cannot be created
    explicit PictureFolder(std::filesystem::path folder);
    /// Writes RGB, replacing an existing file: CV_8UC3 and CV_16UC3 as PNG, for example 000012.png, CV_32FC3
    /// (linear radiance) as EXR of single precision. @throws gi::InputError
    void add(std::uint64_t sequence, cv::Mat const& rgb) const;

private:
    std::filesystem::path folder_;
};

} // namespace ar
