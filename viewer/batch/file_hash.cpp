#include "viewer/batch/file_hash.h"

#include "gi/core/error.h"
#include "gi/core/sha256.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace viewer::batch {

std::string file_sha256(std::filesystem::path const& file)
{
    auto const cannot = [&](std::string const& why) {
        return gi::InputError("cannot read '" + file.string() + "'", why, "check the path and its permissions");
    };
    int const fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) throw cannot(std::strerror(errno));
    struct stat is {};
    bool const is_file = ::fstat(fd, &is) == 0 && S_ISREG(is.st_mode);
    void* const data = is_file && is.st_size > 0
                           ? ::mmap(nullptr, std::size_t(is.st_size), PROT_READ, MAP_PRIVATE, fd, 0)
                           : nullptr;
    ::close(fd);
    if (!is_file) throw cannot("it is no regular file");
    if (data == MAP_FAILED) throw cannot(std::strerror(errno));
    std::string const hash = gi::sha256({static_cast<char const*>(data), std::size_t(is.st_size)});
    if (data != nullptr) ::munmap(data, std::size_t(is.st_size));
    return hash;
}

std::int64_t changed_ns(std::filesystem::path const& file)
{
    struct stat is {};
    return ::stat(file.c_str(), &is) == 0 ? std::int64_t(is.st_mtim.tv_sec) * 1'000'000'000 + is.st_mtim.tv_nsec
                                          : 0;
}

} // namespace viewer::batch
