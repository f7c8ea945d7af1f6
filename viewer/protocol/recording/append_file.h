#pragma once
// A file that grows while the program runs; appending never waits for the disk. One thread writes, another syncs
// to disk once per second. A killed process loses what the writing thread had not yet written; a power failure
// loses about one second more.
//
// If a chunk cannot be written (full disk, or disk too slow for the data), the file ends with the last whole chunk
// before it, because a gap in the middle could be mistaken for real data.

#include "gi/core/report.h"
#include "viewer/protocol/bytes.h"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace viewer {

class AppendFile {
public:
    static constexpr std::size_t kMostWaiting = std::size_t(64) << 20; ///< bytes not yet written

    /// @param what   what the chunks are, for the report: "frames of the recording"
    /// @param report receives losses; must outlive this
    /// Throws InputError if the file exists (nothing is overwritten) or cannot be created.
    AppendFile(std::filesystem::path const& file, std::string what, gi::Report& report);
    ~AppendFile() { close(); }
    AppendFile(AppendFile const&) = delete;
    AppendFile& operator=(AppendFile const&) = delete;

    /// Appends one chunk, which is written whole or not at all.
    void append(std::string_view chunk);
    void append(Bytes const& chunk) { append({reinterpret_cast<char const*>(chunk.data()), chunk.size()}); }
    /// Writes the rest, waits for the disk, and closes. May be called repeatedly.
    void close();

    /// Why writing has stopped; empty if it has not. To be shown once.
    std::string failure() const;
    std::uint64_t written_chunks() const { return written_chunks_; }
    /// Number of chunks that could not be written.
    std::uint64_t lost_chunks() const { return lost_; }

private:
    void write_waiting();
    void sync_every_second();
    void write_chunk(std::string const& chunk);
    void fail(std::string const& why);
    void lose(std::uint64_t chunks);

    std::filesystem::path path_;
    std::string what_;
    gi::Report& report_;
    int file_ = -1;

    mutable std::mutex mutex_; // guards the members below
    std::condition_variable wake_writer_, wake_syncer_;
    std::vector<std::string> waiting_;
    std::size_t waiting_bytes_ = 0;
    std::string failure_;
    bool closing_ = false;

    std::atomic<std::uint64_t> written_{0}; // bytes, all of whole chunks
    std::atomic<std::uint64_t> written_chunks_{0}, lost_{0};
    bool can_write_ = true; // used only by the writing thread
    std::thread writer_, syncer_;
};

} // namespace viewer
