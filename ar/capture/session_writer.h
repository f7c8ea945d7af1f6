#pragma once
// Writes recorded sessions (session_format.h). `append` never waits for the disk: a writer thread writes the data
// and syncs it to disk about once a second. 640 x 480 at 30 frames per second are 14 (nv12) to 28 MB/s (rgb8).

#include "ar/capture/session_format.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace ar {

class SessionWriter {
public:
    static constexpr std::size_t kMostWaiting = std::size_t(64) << 20; ///< bytes not yet written

    /// @throws gi::InputError the folder exists (nothing is overwritten) or cannot be made
    SessionWriter(std::filesystem::path const& folder, SessionHeader header,
                  std::size_t most_waiting = kMostWaiting);
    ~SessionWriter();
    SessionWriter(SessionWriter const&) = delete;
    SessionWriter& operator=(SessionWriter const&) = delete;

    /// Copies the bytes of the frame, which frees the camera's buffer.
    /// @return false if the frame was lost: the queue is full, or writing has failed (see `failure`)
    /// @throws gi::InputError planes that do not match format and size, times that are not finite
    bool append(Frame const& frame);
    /// Records the controls that were set at this moment.
    bool append(Controls const& controls);
    /// Writes the rest of the queue, waits for the disk, and marks session.json as finished. May be called again.
    void finish();

    std::uint64_t written() const { return written_; } ///< frames
    std::uint64_t lost() const { return lost_; }       ///< frames (and controls) that were not written
    /// Why writing has failed; empty if it has not.
    std::string failure() const;

private:
    struct Waiting {
        IndexEntry entry;
        std::vector<std::uint8_t> bytes;
    };
    bool enqueue(Waiting waiting);
    std::vector<std::uint8_t> spare();
    void write_waiting();
    void write(Waiting& waiting);
    void fail(std::string const& why);
    void write_header();

    std::filesystem::path folder_;
    SessionHeader header_;
    std::size_t most_waiting_;
    int frames_file_ = -1, index_file_ = -1;

    mutable std::mutex mutex_; // guards the members below
    std::condition_variable wake_;
    std::deque<Waiting> waiting_;
    std::size_t waiting_bytes_ = 0;
    std::vector<std::vector<std::uint8_t>> spare_; // buffers for reuse
    std::string failure_;
    bool closing_ = false;

    std::uint64_t frames_bytes_ = 0, index_bytes_ = 0; // used by the writer thread
    std::atomic<std::uint64_t> written_{0}, lost_{0};
    std::thread writer_;
};

} // namespace ar
