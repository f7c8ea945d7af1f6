#pragma once
// Column names and embedded pictures in HTML reports.

#include <filesystem>
#include <string>
#include <string_view>

namespace viewer {

/// "frame, s" of "frame_s".
std::string readable(std::string const& column_name);
/// An <img> that holds the PNG itself, or words that say that it is missing.
std::string embedded_png(std::filesystem::path const& file, std::string const& description);
/// An <img> that names a file beside the page; browsers read it when it comes into sight.
std::string linked_png(std::filesystem::path const& file, std::string const& description);
/// The same as embedded_png for a <video> that holds an MP4, which browsers play; other videos are named.
std::string embedded_video(std::filesystem::path const& file, std::string const& description);

} // namespace viewer
