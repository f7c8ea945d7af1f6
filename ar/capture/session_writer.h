#pragma once
// Writes recorded sessions (session_format.h). Whoever appends never waits for the disk: a thread of its own
// writes, and has the disk keep it about once a second. 640 x 480 at 30 frames per second are 14 (nv12) to 28 MB/s
// (rgb8).

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

    /// Copies the bytes of the frame, so that the buffer of the camera is free.
    /// @return false if it was lost: too much is waiting, or nothing can be written any more (see `failure`)
    /// @throws gi::InputError planes that are not what format and size say, times that are not finite
    bool append(Frame const& frame);
    /// What was set at this moment.
    bool append(Controls const& controls);
    /// Writes what waits, waits for the disk, and says in session.json that it is whole. May be called again.
    void finish();

    std::uint64_t written() const { return written_; } ///< frames
    std::uint64_t lost() const { return lost_; }       ///< frames (and controls) that were not written
    /// Why nothing is written any more; empty = all is well.
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

    mutable std::mutex mutex_; // of what follows
    std::condition_variable wake_;
    std::deque<Waiting> waiting_;
    std::size_t waiting_bytes_ = 0;
    std::vector<std::vector<std::uint8_t>> spare_; // memory that was used before
    std::string failure_;
    bool closing_ = false;

    std::uint64_t frames_bytes_ = 0, index_bytes_ = 0; // of the writing thread
    std::atomic<std::uint64_t> written_{0}, lost_{0};
    std::thread writer_;
};

} // namespace ar
