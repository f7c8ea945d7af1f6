#include "gi/core/file.h"

#include "gi/core/error.h"
#include "gi/core/progress.h"
#include "gi/core/temporary_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace gi {

namespace fs = std::filesystem;

void write_by_rename(fs::path const& file, std::function<void(fs::path const&)> const& write)
{
    fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    auto const cannot = [&](std::string const& why, std::string const& suggestion) {
        return InputError("cannot write '" + file.string() + "'", why, suggestion);
    };
    std::error_code error;
    if (!fs::is_directory(folder, error))
        throw cannot("there is no folder '" + folder.string() + "'", "create it first");
    if (fs::exists(file, error) && !fs::is_regular_file(file, error))
        throw cannot("it is a folder or a device", "name a file");
    if (access(folder.c_str(), W_OK) != 0)
        throw cannot("the folder '" + folder.string() + "' is read-only", "choose another folder");

    TemporaryFile temporary(file);
    errno = 0;
    try {
        write(temporary.path());
        if (int const failure = temporary.replace(file); failure != 0)
            throw std::system_error(errno = failure, std::generic_category());
    } catch (InputError const&) {
        throw;
    } catch (Interrupted const&) {
        throw;
    } catch (std::exception const& e) {
        if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EACCES || errno == EIO ||
            errno == EROFS || errno == ENAMETOOLONG)
            throw cannot(std::strerror(errno), "free some space or choose another folder");
        throw cannot(e.what(), "choose another folder");
    }
}

void write_text(fs::path const& file, std::string_view text)
{
    write_by_rename(file, [&](fs::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.exceptions(std::ios::failbit | std::ios::badbit);
        out.write(text.data(), std::streamsize(text.size()));
        out.flush();
    });
}

namespace {

InputError cannot_read(fs::path const& file, std::string const& why, std::string const& suggestion)
{
    return InputError("cannot read '" + file.string() + "'", why, suggestion);
}

} // namespace

std::string lower_extension(fs::path const& file)
{
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

std::uintmax_t regular_file_bytes(fs::path const& file)
{
    std::error_code error;
    fs::file_status const status = fs::status(file, error);
    if (!fs::exists(status)) throw cannot_read(file, "there is no such file", "check the path");
    if (fs::is_directory(status)) throw cannot_read(file, "it is a folder", "name a file in it");
    if (!fs::is_regular_file(status))
        throw cannot_read(file,
                          fs::is_fifo(status)     ? "it is a pipe"
                          : fs::is_socket(status) ? "it is a socket"
                                                  : "it is a device",
                          "name a file");
    std::uintmax_t const size = fs::file_size(file, error);
    if (error) throw cannot_read(file, error.message(), "check the file");
    return size;
}

std::vector<unsigned char> read_bytes(fs::path const& file, std::size_t max_bytes)
{
    std::uintmax_t const size = regular_file_bytes(file);
    if (size > max_bytes)
        throw cannot_read(file, fmt::format("it is larger than {} bytes", max_bytes), "use a smaller file");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw cannot_read(file, std::strerror(errno), "check its permissions");
    std::vector<unsigned char> bytes(size);
    in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    bytes.resize(std::size_t(in.gcount()));
    return bytes;
}

std::string read_text(fs::path const& file, std::size_t max_bytes)
{
    auto const bytes = read_bytes(file, max_bytes);
    return {bytes.begin(), bytes.end()};
}

} // namespace gi
