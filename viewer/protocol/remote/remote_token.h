#pragma once
// The secret that clients of a remote port must know: 32 random bytes as 64 hexadecimal digits, in a file that
// only its owner can read. Whoever can read the owner's files may control the viewer, nobody else.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace viewer {

/// remote-PORT.token in the user's runtime folder (XDG_RUNTIME_DIR, else a folder of mode
/// 0700 in the one for temporary files).
std::filesystem::path default_token_file(int port);

/// Writes a new token and removes it at the end, unless another program has replaced it by then.
class TokenFile {
public:
    /// Replaces an older token, but no other file; the file has mode 0600 from the start. Throws InputError if it
    /// cannot be written, or if its folder in the one for temporary files belongs to somebody else.
    explicit TokenFile(std::filesystem::path file);
    ~TokenFile();
    TokenFile(TokenFile const&) = delete;
    TokenFile& operator=(TokenFile const&) = delete;

    std::string const& token() const { return token_; }
    std::filesystem::path const& file() const { return file_; }

private:
    std::filesystem::path file_;
    std::string token_;
    std::uint64_t inode_ = 0;
};

/// None if there is no such file. Throws InputError if it holds something else or cannot be read.
std::optional<std::string> read_token(std::filesystem::path const& file);

/// Takes the same time for all texts of the same length, so that response times do not
/// reveal a token character by character.
bool is_token(std::string_view given, std::string_view right);

} // namespace viewer
