#pragma once
// A temporary file beside a file, which replaces it atomically once it is complete.

#include <filesystem>

namespace gi {

/// The file is ".NAME.tmp", locked while this object exists. A file that a killed program left there is not
/// locked, and is overwritten the next time NAME is written. If another process is writing it now, or if files
/// cannot be locked, the file is ".NAME.tmp-PID".
class TemporaryFile {
public:
    explicit TemporaryFile(std::filesystem::path const& file);
    ~TemporaryFile();
    TemporaryFile(TemporaryFile const&) = delete;
    TemporaryFile& operator=(TemporaryFile const&) = delete;

    std::filesystem::path const& path() const { return path_; }
    /// Makes it the file itself. @return errno; 0 = done
    int replace(std::filesystem::path const& file);

private:
    std::filesystem::path path_;
    int lock_ = -1;            ///< descriptor; -1 = none
    bool is_replaced_ = false; ///< the name may be that of another process now
};

} // namespace gi
