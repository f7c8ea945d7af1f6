#pragma once
// FFmpeg through OpenCV, in a module of its own (liblightwell_video.so) that is loaded by the first video: its 240
// libraries take 0.2 s.

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace viewer {

/// A video that is being written; complete once it is destroyed.
class VideoStream {
public:
    virtual ~VideoStream() = default;
    /// @param bgr  CV_8UC3 of the video's size, display-encoded
    virtual void write(cv::Mat const& bgr) = 0;
};

class VideoCodec {
public:
    virtual ~VideoCodec() = default;
    /// @param code four letters ("FFV1"). Null where there is no such encoder or the file cannot be written.
    virtual std::unique_ptr<VideoStream> open(std::filesystem::path const& file, char const* code, double fps,
                                              int width, int height) = 0;
    /// How many frames can be decoded; stops counting at `most`.
    virtual int count_frames(std::filesystem::path const& file, int most) = 0;
};

} // namespace viewer

/// What the module exports.
extern "C" viewer::VideoCodec* lightwell_video_codec();
