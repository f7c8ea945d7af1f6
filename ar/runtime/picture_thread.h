#pragma once
// Stores pictures (or what else a frame leaves) in a separate thread, so that a run does not wait for files.

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <thread>

namespace ar {

struct KeptPicture {
    std::uint64_t sequence = 0;
    double time_s = 0; ///< since the first
    cv::Mat rgb;       ///< CV_8UC3, CV_16UC3 or CV_32FC3, must not be modified any more
};

enum class WhenFull {
    wait,
    lose ///< discard the newest, and count it
};

template <typename Item>
class KeepThread {
public:
    using WhenFull = ar::WhenFull;

    /// @param keep  called on a thread of its own, in order
    /// @param most  items that wait
    KeepThread(std::function<void(Item const&)> keep, WhenFull when_full, std::size_t most = 8)
        : keep_(std::move(keep)), when_full_(when_full), most_(most), thread_([this] { keep_all(); })
    {
    }
    ~KeepThread() { end(true); } ///< discards waiting items
    KeepThread(KeepThread const&) = delete;
    KeepThread& operator=(KeepThread const&) = delete;

    /// Rethrows an exception of `keep`; after it nothing more is stored.
    void add(Item item)
    {
        std::unique_lock lock(mutex_);
        if (when_full_ == WhenFull::wait) changed_.wait(lock, [&] { return waiting_.size() < most_ || problem_; });
        if (problem_) std::rethrow_exception(problem_);
        if (waiting_.size() >= most_) {
            ++lost_;
            return;
        }
        waiting_.push_back(std::move(item));
        changed_.notify_all();
    }
    /// Waits until all items are stored; throws as `add`.
    void finish()
    {
        end(false);
        if (problem_) std::rethrow_exception(problem_);
    }
    std::uint64_t lost() const { return lost_; } ///< call from the adding thread

private:
    void keep_all()
    {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return !waiting_.empty() || is_closed_; });
            if (waiting_.empty()) return;
            Item const item = std::move(waiting_.front());
            waiting_.pop_front();
            changed_.notify_all();
            lock.unlock();
            try {
                keep_(item);
                lock.lock();
            } catch (...) {
                lock.lock();
                problem_ = std::current_exception();
                changed_.notify_all();
                return;
            }
        }
    }
    void end(bool gives_up)
    {
        {
            std::lock_guard const lock(mutex_);
            if (gives_up) waiting_.clear();
            is_closed_ = true;
        }
        changed_.notify_all();
        if (thread_.joinable()) thread_.join();
    }

    std::function<void(Item const&)> keep_;
    WhenFull when_full_;
    std::size_t most_;
    std::uint64_t lost_ = 0;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::deque<Item> waiting_;
    bool is_closed_ = false;
    std::exception_ptr problem_;
    std::thread thread_;
};

using PictureThread = KeepThread<KeptPicture>;

} // namespace ar
