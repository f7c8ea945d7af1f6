#include "viewer/protocol/remote/remote_token.h"

#include "gi/core/error.h"
#include "viewer/protocol/remote/socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBytes = 32;

std::string random_token()
{
    std::array<unsigned char, kBytes> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
        throw gi::InputError("no token can be made for the remote port", std::strerror(errno),
                             "use --remote PATH instead");
    std::string text;
    for (unsigned char const b : bytes) text += fmt::format("{:02x}", b);
    return text;
}

/// Folder where only this user can write; throws if somebody else made it first.
void make_private(fs::path const& folder)
{
    if (::mkdir(folder.c_str(), 0700) == 0 || errno != EEXIST) return; // opening the file reports what is wrong
    struct stat about {};
    bool const ours =
        ::lstat(folder.c_str(), &about) == 0 && S_ISDIR(about.st_mode) && about.st_uid == ::geteuid();
    if (!ours || (about.st_mode & 022) != 0)
        throw gi::InputError("the folder " + folder.string() + " cannot hold the token of the remote port",
                             ours ? "others can write to it" : "it belongs to somebody else",
                             "set XDG_RUNTIME_DIR, or choose a file by --remote-token");
}

} // namespace

fs::path default_token_file(int port)
{
    char const* const runtime = std::getenv("XDG_RUNTIME_DIR");
    std::error_code failure;
    fs::path folder;
    if (runtime != nullptr && fs::path(runtime).is_absolute() && fs::is_directory(runtime, failure))
        folder = fs::path(runtime) / "lightwell";
    else
        folder = fs::temp_directory_path(failure) / fmt::format("lightwell-{}", ::geteuid());
    return folder / fmt::format("remote-{}.token", port);
}

TokenFile::TokenFile(fs::path file) : file_(fs::absolute(std::move(file))), token_(random_token())
{
    if (file_.parent_path().filename().string().starts_with("lightwell")) make_private(file_.parent_path());
    auto const refuse = [this](int error) {
        throw gi::InputError("the token of the remote port cannot be written to " + file_.string(),
                             std::strerror(error), "choose another file by --remote-token");
    };
    struct stat about {};
    if (::lstat(file_.c_str(), &about) == 0) {
        if (!S_ISREG(about.st_mode)) refuse(EEXIST);
        read_token(file_); // throws rather than replace a file that holds something else
    }
    if (::unlink(file_.c_str()) != 0 && errno != ENOENT) refuse(errno);
    Socket const out(::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!out.is_open()) refuse(errno);
    std::string const line = fmt::format("{}\n", token_);
    if (::fchmod(out.fd(), 0600) != 0 || ::write(out.fd(), line.data(), line.size()) != ssize_t(line.size()))
        refuse(errno);
    if (::fstat(out.fd(), &about) == 0) inode_ = about.st_ino;
}

TokenFile::~TokenFile()
{
    struct stat about {};
    if (::lstat(file_.c_str(), &about) == 0 && about.st_ino == inode_) ::unlink(file_.c_str());
}

std::optional<std::string> read_token(fs::path const& file)
{
    std::error_code failure;
    if (!fs::exists(file, failure)) return {};
    std::ifstream in(file);
    std::string token(2 * kBytes, ' ');
    in.read(token.data(), std::streamsize(token.size()));
    int const end = in.get(); // nothing, or the end of the line
    if (in.bad() || (end != '\n' && end != std::ifstream::traits_type::eof()) ||
        token.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw gi::InputError("'" + file.string() + "' holds no token of a remote port",
                             in.bad() || !in.is_open() ? "it cannot be read" : "a token is 64 hexadecimal digits",
                             "name the file that the viewer printed");
    return token;
}

bool is_token(std::string_view given, std::string_view right)
{
    std::size_t difference = given.size() ^ right.size();
    for (std::size_t k = 0; k < right.size(); ++k)
        difference |= std::size_t((unsigned char)(right[k] ^ (k < given.size() ? given[k] : 0)));
    return difference == 0;
}

} // namespace viewer
