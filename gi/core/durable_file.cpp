#include "gi/core/durable_file.h"

#include "gi/core/error.h"
#include "gi/core/temporary_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace gi {
namespace {

namespace fs = std::filesystem;

InputError cannot(char const* what, fs::path const& file, int error)
{
    return InputError(TextLocation{file.string()}, what, std::strerror(error),
                      error == ENOENT ? "check the path" : "free some space, or choose another folder");
}

struct Descriptor {
    int fd = -1;
    ~Descriptor()
    {
        if (fd >= 0) ::close(fd);
    }
};

/// Returns errno, 0 = all is written.
int write_all(int fd, std::string_view text)
{
    for (std::size_t at = 0; at < text.size();) {
        ssize_t const n = ::write(fd, text.data() + at, text.size() - at);
        if (n > 0) at += std::size_t(n);
        if (n < 0 && errno != EINTR) return errno;
        if (n == 0) return ENOSPC;
    }
    return 0;
}

/// Puts a file that was opened without a name in the place of `file`. Returns errno.
int replace_by_nameless(fs::path const& file, int fd)
{
    fs::path const temporary =
        file.parent_path() / ("." + file.filename().string() + ".tmp-" + std::to_string(getpid()));
    ::unlink(temporary.c_str());
    std::string const opened = "/proc/self/fd/" + std::to_string(fd);
    if (::linkat(AT_FDCWD, opened.c_str(), AT_FDCWD, temporary.c_str(), AT_SYMLINK_FOLLOW) != 0) return errno;
    if (::rename(temporary.c_str(), file.c_str()) == 0) return 0;
    int const error = errno;
    ::unlink(temporary.c_str());
    return error;
}

} // namespace

void write_durably(fs::path const& file, std::string_view text) { write_durably(file, {&text, 1}); }

void write_durably(fs::path const& file, std::span<std::string_view const> parts, DiskWait wait)
{
    fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    Descriptor out{::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666)};
    std::optional<TemporaryFile> named;
    if (out.fd < 0) {
        named.emplace(file);
        out.fd = ::open(named->path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    }
    if (out.fd < 0) throw cannot("the file cannot be written", file, errno);
    int failure = 0;
    for (std::size_t k = 0; k < parts.size() && failure == 0; ++k) failure = write_all(out.fd, parts[k]);
    if (failure == 0 && wait == DiskWait::yes && ::fsync(out.fd) != 0) failure = errno;
    if (failure == 0) failure = named ? named->replace(file) : replace_by_nameless(file, out.fd);
    if (failure != 0) throw cannot("the file cannot be written", file, failure);
    if (wait == DiskWait::yes) sync_folder(folder);
}

void sync_folder(fs::path const& folder)
{
    Descriptor const at{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    if (at.fd >= 0) ::fsync(at.fd);
}

void make_folder(fs::path const& folder)
{
    if (folder.empty() || ::access(folder.c_str(), F_OK) == 0) {
        std::error_code ignored;
        if (!folder.empty() && !fs::is_directory(folder, ignored))
            throw cannot("the folder cannot be made", folder, ENOTDIR);
        return;
    }
    fs::path const parent = folder.parent_path();
    if (parent != folder) make_folder(parent);
    if (::mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST)
        throw cannot("the folder cannot be made", folder, errno);
    sync_folder(parent.empty() ? fs::path(".") : parent);
}

} // namespace gi
