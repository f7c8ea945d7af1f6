#include "ar/runtime/picture_thread.h"

namespace viewer {

PictureThread::PictureThread(std::function<void(NumberedPicture const&)> keep, WhenFull when_full)
    : keep_(std::move(keep)), when_full_(when_full), thread_([this] { keep_all(); })
{
}

PictureThread::~PictureThread() { end(true); }

void PictureThread::end(bool gives_up)
{
    {
        std::lock_guard const lock(mutex_);
        if (gives_up) waiting_.clear();
        is_closed_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void PictureThread::keep_all()
{
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return !waiting_.empty() || is_closed_; });
        if (waiting_.empty()) return;
        NumberedPicture const picture = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        lock.unlock();
        try {
            keep_(picture);
            lock.lock();
        } catch (...) {
            lock.lock();
            problem_ = std::current_exception();
            changed_.notify_all();
            return;
        }
    }
}

void PictureThread::add(NumberedPicture picture)
{
    std::unique_lock lock(mutex_);
    if (when_full_ == WhenFull::wait)
        changed_.wait(lock, [&] { return waiting_.size() < kMostWaiting || problem_; });
    if (problem_) std::rethrow_exception(problem_);
    if (waiting_.size() >= kMostWaiting) {
        ++lost_;
        return;
    }
    waiting_.push_back(std::move(picture));
    changed_.notify_all();
}

void PictureThread::finish()
{
    end(false);
    if (problem_) std::rethrow_exception(problem_);
}

} // namespace viewer
