#include "gi/core/temporary_file.h"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gi {
namespace {

namespace fs = std::filesystem;

bool is_named(int fd, fs::path const& path)
{
    struct stat held {
    }, named{};
    return ::fstat(fd, &held) == 0 && ::lstat(path.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
           held.st_ino == named.st_ino && S_ISREG(held.st_mode) && held.st_nlink == 1;
}

/// @return descriptor of the locked, empty file; -1 where that cannot be had
int lock(fs::path const& path)
{
    int const fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (fd < 0) return -1;
    // Before it was locked, another process may have renamed it.
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0 && is_named(fd, path) && ::ftruncate(fd, 0) == 0) return fd;
    ::close(fd);
    return -1;
}

} // namespace

TemporaryFile::TemporaryFile(fs::path const& file)
    : path_(file.parent_path() / ("." + file.filename().string() + ".tmp")), lock_(lock(path_))
{
    if (lock_ < 0) path_ += "-" + std::to_string(getpid());
}

TemporaryFile::~TemporaryFile()
{
    if (!is_replaced_) ::unlink(path_.c_str());
    if (lock_ >= 0) ::close(lock_);
}

int TemporaryFile::replace(fs::path const& file)
{
    is_replaced_ = ::rename(path_.c_str(), file.c_str()) == 0;
    return is_replaced_ ? 0 : errno;
}

} // namespace gi
