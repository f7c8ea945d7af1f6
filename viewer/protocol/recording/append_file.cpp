#include "viewer/protocol/recording/append_file.h"

#include "gi/core/durable_file.h"
#include "gi/core/error.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace viewer {
namespace {

int make_file(std::filesystem::path const& path)
{
    int const file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) return file;
    bool const exists = errno == EEXIST;
    throw gi::InputError("cannot make '" + path.string() + "'",
                         exists ? "it exists, and recorded data is never overwritten" : std::strerror(errno),
                         exists ? "choose another name, or move it away" : "choose a folder that can be written");
}

} // namespace

AppendFile::AppendFile(std::filesystem::path const& file, std::string what, gi::Report& report)
    : path_(file), what_(std::move(what)), report_(report), file_(make_file(file))
{
    gi::sync_folder(file.has_parent_path() ? file.parent_path() : "."); // its name survives a loss of power too
    writer_ = std::thread([this] { write_waiting(); });
    syncer_ = std::thread([this] { sync_every_second(); });
}

void AppendFile::append(std::string_view chunk)
{
    {
        std::lock_guard const lock(mutex_);
        if (failure_.empty() && !closing_ && waiting_bytes_ + chunk.size() <= kMostWaiting) {
            waiting_.emplace_back(chunk);
            waiting_bytes_ += chunk.size();
            wake_writer_.notify_one();
            return;
        }
        if (failure_.empty()) failure_ = closing_ ? "it is closed already" : "the disk is too slow for the data";
    }
    lose(1);
}

void AppendFile::close()
{
    {
        std::lock_guard const lock(mutex_);
        if (closing_) return;
        closing_ = true;
        wake_writer_.notify_one();
        wake_syncer_.notify_one();
    }
    writer_.join();
    syncer_.join();
    if (::fdatasync(file_) != 0) fail(std::strerror(errno));
    if (::close(file_) != 0) fail(std::strerror(errno));
}

std::string AppendFile::failure() const
{
    std::lock_guard const lock(mutex_);
    return failure_;
}

void AppendFile::write_waiting()
{
    for (;;) {
        std::vector<std::string> chunks;
        {
            std::unique_lock lock(mutex_);
            wake_writer_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
            if (waiting_.empty()) return;
            chunks.swap(waiting_);
        }
        for (std::string const& chunk : chunks) {
            write_chunk(chunk);
            std::lock_guard const lock(mutex_);
            waiting_bytes_ -= chunk.size();
        }
    }
}

void AppendFile::write_chunk(std::string const& chunk)
{
    if (!can_write_) return lose(1);
    for (std::size_t done = 0; done < chunk.size();) {
        ssize_t const n = ::write(file_, chunk.data() + done, chunk.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            fail(n == 0 ? "the disk accepts no data" : std::strerror(errno));
            can_write_ = false;
            if (::ftruncate(file_, off_t(written_.load())) != 0) fail(std::strerror(errno)); // part of a chunk
            return lose(1);
        }
        done += std::size_t(n);
    }
    written_ += chunk.size();
    ++written_chunks_;
}

void AppendFile::sync_every_second()
{
    std::uint64_t synced = 0;
    std::unique_lock lock(mutex_);
    while (!wake_syncer_.wait_for(lock, std::chrono::seconds(1), [&] { return closing_; })) {
        if (synced == written_) continue;
        lock.unlock();
        synced = written_;
        int const error = ::fdatasync(file_) == 0 ? 0 : errno;
        if (error != 0) fail(std::strerror(error));
        lock.lock();
    }
}

void AppendFile::fail(std::string const& why)
{
    std::lock_guard const lock(mutex_);
    if (failure_.empty()) failure_ = why;
}

void AppendFile::lose(std::uint64_t chunks)
{
    lost_ += chunks;
    report_.lose(what_ + " not written", chunks, "'" + path_.string() + "': " + failure());
}

} // namespace viewer
