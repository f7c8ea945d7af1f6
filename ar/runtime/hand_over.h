#pragma once
// Passes items from one thread to another; holds one item at most.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace ar {

template <typename T>
class HandOver {
public:
    /// Waits until there is room. @return false if abandoned; `thing` is discarded
    bool put(T thing)
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !waiting_ || is_abandoned_; });
        if (is_abandoned_) return false;
        waiting_ = std::move(thing);
        changed_.notify_all();
        return true;
    }
    /// Replaces the waiting item, if any, after calling `merge(older, thing)` under the lock.
    template <typename Merge>
    bool replace(T thing, Merge const& merge)
    {
        std::optional<T> older; // destroyed after the lock is released
        {
            std::lock_guard const lock(mutex_);
            if (is_abandoned_) return false;
            older = std::exchange(waiting_, std::nullopt);
            if (older) merge(*older, thing);
            waiting_ = std::move(thing);
        }
        changed_.notify_all();
        return true;
    }
    /// Takes the next item; nothing if none came within that time, or none will.
    template <typename Duration>
    std::optional<T> take(Duration wait)
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, wait, [&] { return waiting_ || is_closed_ || is_abandoned_; });
        return taken(lock);
    }
    /// Waits for the next item; nothing if none will come.
    std::optional<T> take()
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return waiting_ || is_closed_ || is_abandoned_; });
        return taken(lock);
    }
    /// No more items will be put; a waiting one can still be taken.
    void close()
    {
        std::lock_guard const lock(mutex_);
        is_closed_ = true;
        changed_.notify_all();
    }
    /// Ends all waiting on both sides.
    void abandon()
    {
        std::lock_guard const lock(mutex_);
        is_abandoned_ = true;
        changed_.notify_all();
    }
    bool has_ended() const
    {
        std::lock_guard const lock(mutex_);
        return is_abandoned_ || (is_closed_ && !waiting_);
    }

private:
    std::optional<T> taken(std::unique_lock<std::mutex>& lock)
    {
        if (is_abandoned_) return std::nullopt;
        std::optional<T> thing = std::exchange(waiting_, std::nullopt);
        lock.unlock();
        changed_.notify_all();
        return thing;
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<T> waiting_;
    bool is_closed_ = false, is_abandoned_ = false;
};

} // namespace ar
