#include "study/run/journal.h"

#include "gi/core/durable_file.h"
#include "study/journal/entry_line.h"
#include "study/script/script_error.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace study {
namespace {

constexpr std::size_t kRoom = std::size_t(256) << 10; ///< about 250 trials

/// @return errno, or 0
int write_all(int fd, std::string_view text, std::size_t at)
{
    while (!text.empty()) {
        ssize_t const n = ::pwrite(fd, text.data(), text.size(), off_t(at));
        if (n == 0) return ENOSPC;
        if (n < 0 && errno != EINTR) return errno;
        if (n < 0) continue;
        at += std::size_t(n);
        text.remove_prefix(std::size_t(n));
    }
    return 0;
}

ScriptError cannot(std::filesystem::path const& file, char const* what, std::string const& why,
                   char const* suggestion)
{
    return ScriptError(file.string(), {}, what, why, suggestion);
}

void lock(int fd, std::filesystem::path const& file)
{
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return;
    int const error = errno;
    ::close(fd);
    if (error == EWOULDBLOCK)
        throw cannot(file, "this session is running", "another process has its journal", "end that one first");
    throw cannot(file, "the journal cannot be locked", std::strerror(error),
                 "keep the records on a disk that can lock files");
}

} // namespace

Journal::Journal(std::filesystem::path file, int descriptor) : file_(std::move(file)), fd_(descriptor) {}

Journal::Journal(Journal&& other) noexcept
    : file_(std::move(other.file_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_),
      room_(other.room_),
      lines_(other.lines_),
      has_failed_(other.has_failed_),
      synced_ms_(other.synced_ms_)
{
}

Journal::~Journal()
{
    if (fd_ < 0) return;
    if (room_ > size_ && ::ftruncate(fd_, off_t(size_)) == 0) ::fdatasync(fd_);
    ::close(fd_); // also releases the lock
}

Journal Journal::create(std::filesystem::path const& file)
{
    int const fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        throw cannot(file, "the journal cannot be created", std::strerror(errno), "choose a writable folder");
    lock(fd, file);
    gi::sync_folder(file.parent_path());
    return {file, fd};
}

Journal Journal::open(std::filesystem::path const& file, JournalText& found)
{
    int const fd = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        throw cannot(file, "the journal cannot be opened", std::strerror(errno),
                     errno == ENOENT ? "check participant, session and folder" : "make it writable");
    struct stat is {};
    if (::fstat(fd, &is) != 0 || !S_ISREG(is.st_mode)) {
        ::close(fd);
        throw cannot(file, "the journal cannot be opened", "it is not a regular file", "restore it");
    }
    lock(fd, file);
    Journal journal{file, fd};
    found = read_journal(file);
    bool const is_longer = found.torn_bytes > 0 || found.room_bytes > 0;
    if (is_longer && (::ftruncate(fd, off_t(found.good_bytes)) != 0 || ::fsync(fd) != 0))
        throw cannot(file, "the incomplete last line of the journal cannot be cut off", std::strerror(errno),
                     "make it writable");
    journal.size_ = journal.room_ = found.good_bytes;
    journal.lines_ = int(found.record.entries.size());
    return journal;
}

void Journal::make_room(std::size_t bytes)
{
    std::size_t const before = room_;
    if (write_all(fd_, std::string(bytes, '\n'), room_) == 0 && ::fsync(fd_) == 0)
        room_ += bytes;
    else if (::ftruncate(fd_, off_t(before)) != 0)
        fail(errno);
}

void Journal::append(JournalEntry const& entry)
{
    if (has_failed_) throw std::logic_error("write to a journal after it has failed");
    std::string const line = entry_line(entry, lines_ + 1) + "\n";
    if (size_ + line.size() > room_) make_room(kRoom);
    if (int const error = write_all(fd_, line, size_)) fail(error);
    auto const before = std::chrono::steady_clock::now();
    if (::fdatasync(fd_) != 0) fail(errno);
    synced_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count();
    size_ += line.size();
    room_ = std::max(room_, size_);
    ++lines_;
}

void Journal::fail(int error)
{
    has_failed_ = true;
    // If even this fails, the next process that opens the file does it.
    if (::ftruncate(fd_, off_t(size_)) == 0) ::fdatasync(fd_);
    room_ = size_;
    throw cannot(
        file_, "the session stops: its journal cannot be written", std::strerror(error),
        "all trials up to the last are recorded: free some space, or repair the disk, and resume the session");
}

} // namespace study
