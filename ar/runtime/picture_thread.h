#pragma once
// Keeps pictures while a run goes on: whoever makes them does not wait for files.

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
    cv::Mat rgb;       ///< CV_8UC3, not written to any more
};

class PictureThread {
public:
    static constexpr std::size_t kMostWaiting = 8;
    enum class WhenFull {
        wait,
        lose ///< the newest, and count it
    };

    /// @param keep  called on a thread of its own, in order
    PictureThread(std::function<void(NumberedPicture const&)> keep, WhenFull when_full);
    ~PictureThread(); ///< what waits is given up
    PictureThread(PictureThread const&) = delete;
    PictureThread& operator=(PictureThread const&) = delete;

    /// Throws what `keep` threw; then nothing more is kept.
    void add(NumberedPicture picture);
    /// Waits until all is kept; throws as `add`.
    void finish();
    std::uint64_t lost() const { return lost_; } ///< of the thread that adds

private:
    void keep_all();
    void end(bool gives_up);

    std::function<void(NumberedPicture const&)> keep_;
    WhenFull when_full_;
    std::uint64_t lost_ = 0;
    std::mutex mutex_; // of what follows
    std::condition_variable changed_;
    std::deque<NumberedPicture> waiting_;
    bool is_closed_ = false;
    std::exception_ptr problem_;
    std::thread thread_;
};

} // namespace viewer
