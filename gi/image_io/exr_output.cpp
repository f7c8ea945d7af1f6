#include "gi/image_io/exr_output.h"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace gi {
namespace {

constexpr std::size_t kMostWaiting = std::size_t(1) << 20;

} // namespace

ExrOutput::ExrOutput(std::filesystem::path const& file)
    : Imf::OStream(file.c_str()), fd_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
{
    if (fd_ < 0) fail(errno);
    waiting_.reserve(kMostWaiting);
}

ExrOutput::~ExrOutput()
{
    if (fd_ >= 0) ::close(fd_);
}

void ExrOutput::fail(int error)
{
    if (error_ == 0) error_ = error;
    errno = error_; // callers recognise a full disk by it
    throw std::system_error(error_, std::generic_category());
}

void ExrOutput::write(char const bytes[], int n)
{
    if (waiting_.size() + std::size_t(n) > kMostWaiting) flush();
    waiting_.insert(waiting_.end(), bytes, bytes + n);
}

void ExrOutput::seekp(std::uint64_t to)
{
    flush();
    at_ = to;
}

void ExrOutput::flush()
{
    if (error_ != 0) fail(error_);
    for (std::size_t done = 0; done < waiting_.size();) {
        ssize_t const n = ::pwrite(fd_, waiting_.data() + done, waiting_.size() - done, off_t(at_ + done));
        int const error = n == 0 ? ENOSPC : n < 0 ? errno : 0;
        if (error != 0 && error != EINTR) fail(error);
        if (n > 0) done += std::size_t(n);
    }
    at_ += waiting_.size();
    waiting_.clear();
}

void ExrOutput::finish()
{
    flush();
    if (::close(std::exchange(fd_, -1)) != 0) fail(errno); // it may still hand bytes to a server
}

} // namespace gi
