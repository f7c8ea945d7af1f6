#include "gi/image_io/exr_output.h"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace gi {
namespace {

constexpr std::size_t kMostWaiting = std::size_t(1) << 20;

[[noreturn]] void fail(int error) { throw std::system_error(error, std::generic_category()); }

} // namespace

ExrOutput::ExrOutput(std::filesystem::path const& file)
    : Imf::OStream(file.c_str()), fd_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
{
    if (fd_ < 0) fail(errno);
    waiting_.reserve(kMostWaiting);
}

ExrOutput::~ExrOutput() { ::close(fd_); }

void ExrOutput::write(char const bytes[], int n)
{
    if (waiting_.size() + std::size_t(n) > kMostWaiting) finish();
    waiting_.insert(waiting_.end(), bytes, bytes + n);
}

void ExrOutput::seekp(std::uint64_t to)
{
    finish();
    at_ = to;
}

void ExrOutput::finish()
{
    for (std::size_t done = 0; done < waiting_.size();) {
        ssize_t const n = ::pwrite(fd_, waiting_.data() + done, waiting_.size() - done, off_t(at_ + done));
        if (n == 0 || (n < 0 && errno != EINTR)) fail(errno = n == 0 ? ENOSPC : errno);
        if (n > 0) done += std::size_t(n);
    }
    at_ += waiting_.size();
    waiting_.clear();
}

} // namespace gi
