#pragma once
// Writes video files.

#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace viewer {

class Ffmpeg;

/// Throws InputError if a video with this name, size and rate is impossible. Possible are .mkv (FFV1, lossless)
/// and .mp4 (H.264), even sizes, 0.01 to 1000 frames per second. Writes nothing.
void check_video(std::filesystem::path const& file, int width, int height, double fps);

/// Writes a video under a hidden name beside `file`; finish() checks it and renames it to `file`.
/// An unfinished video is removed.
class VideoWriter {
public:
    /// Throws InputError as check_video does, or if there is no ffmpeg or the folder cannot be written.
    VideoWriter(std::filesystem::path const& file, int width, int height, double fps);
    ~VideoWriter();
    VideoWriter(VideoWriter const&) = delete;
    VideoWriter& operator=(VideoWriter const&) = delete;

    /// Adds a display-encoded frame; rgb8.size() == 3 * width * height. Throws InputError if ffmpeg has
    /// ended, with what it said (no such encoder, a full disk).
    void add(std::span<unsigned char const> rgb8);
    int frames() const { return frames_; }
    /// Throws InputError unless all frames can be read back.
    void finish();

private:
    [[noreturn]] void fail();
    void remove_unfinished();

    std::filesystem::path file_, temporary_;
    int frames_ = 0;
    std::unique_ptr<Ffmpeg> ffmpeg_;
};

} // namespace viewer
