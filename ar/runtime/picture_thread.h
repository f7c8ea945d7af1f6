#pragma once
// Stores pictures in a separate thread, so that a run does not wait for files.

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <thread>

namespace viewer {

struct NumberedPicture {
    std::uint64_t sequence = 0;
    double time_s = 0; ///< since the first
    cv::Mat rgb;       ///< CV_8UC3, must not be modified any more
};

class PictureThread {
public:
    static constexpr std::size_t kMostWaiting = 8;
    enum class WhenFull {
        wait,
        lose ///< discard the newest, and count it
    };

    /// @param keep  called on a thread of its own, in order
    PictureThread(std::function<void(NumberedPicture const&)> keep, WhenFull when_full);
    ~PictureThread(); ///< discards waiting pictures
    PictureThread(PictureThread const&) = delete;
    PictureThread& operator=(PictureThread const&) = delete;

    /// Rethrows an exception of `keep`; after it nothing more is stored.
    void add(NumberedPicture picture);
    /// Waits until all pictures are stored; throws as `add`.
    void finish();
    std::uint64_t lost() const { return lost_; } ///< call from the adding thread

private:
    void keep_all();
    void end(bool gives_up);

    std::function<void(NumberedPicture const&)> keep_;
    WhenFull when_full_;
    std::uint64_t lost_ = 0;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::deque<NumberedPicture> waiting_;
    bool is_closed_ = false;
    std::exception_ptr problem_;
    std::thread thread_;
};

} // namespace viewer
