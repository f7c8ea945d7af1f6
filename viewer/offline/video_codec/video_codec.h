#pragma once
// FFmpeg through OpenCV, in its own module (liblightwell_video.so), which is loaded for the first video, as its
// 240 libraries take 0.2 s to load.

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace viewer {

/// A video being written; it is complete when this object is destroyed.
class VideoStream {
public:
    virtual ~VideoStream() = default;
    /// @param bgr  CV_8UC3 of the video's size, display-encoded
    virtual void write(cv::Mat const& bgr) = 0;
};

class VideoCodec {
public:
    virtual ~VideoCodec() = default;
    /// @param code FourCC ("FFV1"). Returns null if there is no such encoder or the file cannot be written.
    virtual std::unique_ptr<VideoStream> open(std::filesystem::path const& file, char const* code, double fps,
                                              int width, int height) = 0;
    /// Number of frames that can be decoded; stops counting at `most`.
    virtual int count_frames(std::filesystem::path const& file, int most) = 0;
};

} // namespace viewer

/// Function exported by the module.
extern "C" viewer::VideoCodec* lightwell_video_codec();
