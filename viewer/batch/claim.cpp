#include "viewer/batch/claim.h"

#include "gi/core/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace viewer::batch {
namespace {

struct flock byte_lock(long long at)
{
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = at;
    lock.l_len = 1;
    return lock;
}

} // namespace

Claim::Claim(std::filesystem::path const& folder, std::string const& key)
    : at_((long long)(std::stoull(key.substr(2, 15), nullptr, 16)))
{
    std::filesystem::path const file = folder / key.substr(0, 2);
    fd_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ < 0)
        throw gi::InputError("cannot claim a task in '" + file.string() + "'", std::strerror(errno),
                             "make the store writable");
}

Claim::~Claim() { ::close(fd_); }

bool Claim::take()
{
    struct flock lock = byte_lock(at_);
    if (::fcntl(fd_, F_OFD_SETLK, &lock) == 0) return true;
    if (errno == EAGAIN || errno == EACCES) return false;
    throw gi::InputError("cannot lock a task in the store", std::strerror(errno),
                         "keep the store on a disk that can lock files");
}

bool Claim::is_taken_elsewhere() const
{
    struct flock lock = byte_lock(at_);
    return ::fcntl(fd_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

} // namespace viewer::batch
