#pragma once
// For libcamera_source.cpp only, the one place that knows libcamera.

#include "ar/capture/buffer_memory.h"
#include "gi/core/error.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <libcamera/libcamera.h>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace ar {

namespace lc = libcamera;

/// Text of a libcamera error code (negative errno).
inline std::string text_of_error(int code) { return std::strerror(code < 0 ? -code : code); }

/// The requests of a running camera: queued at the camera, completed and waiting here, or in use by a frame.
/// Frames share ownership of the pool, so it outlives the source while any frame exists.
class RequestPool {
public:
    struct Buffer {
        std::unique_ptr<lc::FrameBuffer> own; ///< null if libcamera's allocator owns it
        std::vector<std::span<std::uint8_t const>> planes;
        std::vector<int> files;
    };

    explicit RequestPool(std::shared_ptr<lc::Camera> const& camera) : camera_(camera.get()) {}

    void add(lc::Stream* stream, lc::FrameBuffer* buffer, std::unique_ptr<lc::FrameBuffer> own)
    {
        Buffer b{std::move(own), {}, {}};
        std::vector<BufferMemory::Plane> planes;
        for (lc::FrameBuffer::Plane const& p : buffer->planes()) {
            bool const is_known = p.offset != lc::FrameBuffer::Plane::kInvalidOffset;
            planes.push_back({p.fd.get(), is_known ? p.offset : 0, p.length});
            if (std::find(b.files.begin(), b.files.end(), p.fd.get()) == b.files.end())
                b.files.push_back(p.fd.get());
        }
        b.planes = memory_.map(planes);
        std::unique_ptr<lc::Request> request = camera_->createRequest(buffers_.size());
        if (!request || request->addBuffer(stream, buffer) != 0)
            throw gi::InputError("the camera takes no buffers", "its driver refuses them", "use another camera");
        buffers_.push_back(std::move(b));
        requests_.push_back(std::move(request));
    }

    std::size_t size() const { return requests_.size(); }
    Buffer const& buffer_of(lc::Request const& request) const { return buffers_[std::size_t(request.cookie())]; }

    void queue_all()
    {
        std::lock_guard const lock(mutex_);
        running_ = true;
        for (auto const& request : requests_) queue(*request);
    }
    void stop() // call before stopping the camera
    {
        std::lock_guard const lock(mutex_);
        running_ = false;
        completed_.clear();
    }
    void forget_requests()
    {
        std::lock_guard const lock(mutex_);
        requests_.clear();
        for (Buffer& b : buffers_) b.own.reset();
    }

    /// Called by the camera's thread.
    void complete(lc::Request* request)
    {
        std::lock_guard const lock(mutex_);
        if (!running_ || request->status() == lc::Request::RequestCancelled) return;
        completed_.push_back(request);
        changed_.notify_one();
    }
    void lose(std::string const& reason)
    {
        std::lock_guard const lock(mutex_);
        lose_locked(reason);
    }

    /// The oldest completed request, or null if none arrives within `wait`.
    lc::Request* take(std::chrono::milliseconds wait)
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, wait, [&] { return !completed_.empty() || !lost_.empty(); });
        if (completed_.empty()) return nullptr;
        lc::Request* const request = completed_.front();
        completed_.pop_front();
        return request;
    }
    bool has_waiting() const
    {
        std::lock_guard const lock(mutex_);
        return !completed_.empty();
    }
    void give_back(lc::Request* request)
    {
        std::lock_guard const lock(mutex_);
        if (!running_) return;
        for (int const file : buffer_of(*request).files) tell_driver(file, Reading::ends);
        request->reuse(lc::Request::ReuseBuffers);
        queue(*request);
    }

    void set_controls(lc::ControlList const& controls)
    {
        std::lock_guard const lock(mutex_);
        if (!next_controls_)
            next_controls_ = controls;
        else
            for (auto const& [id, value] : controls) next_controls_->set(id, value);
    }
    /// Why the camera was lost; empty if it was not.
    std::string loss() const
    {
        std::lock_guard const lock(mutex_);
        return lost_;
    }

private:
    void queue(lc::Request& request)
    {
        if (next_controls_) {
            for (auto const& [id, value] : *next_controls_) request.controls().set(id, value);
            next_controls_.reset();
        }
        if (int const error = camera_->queueRequest(&request); error != 0)
            lose_locked("the camera takes no more requests: " + text_of_error(error));
    }
    void lose_locked(std::string const& reason)
    {
        if (lost_.empty()) lost_ = reason;
        changed_.notify_one();
    }

    lc::Camera* camera_; // used only while running_
    BufferMemory memory_;
    std::vector<Buffer> buffers_;

    mutable std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::vector<std::unique_ptr<lc::Request>> requests_;
    std::deque<lc::Request*> completed_;
    std::optional<lc::ControlList> next_controls_;
    std::string lost_;
    bool running_ = false;
};

} // namespace ar
