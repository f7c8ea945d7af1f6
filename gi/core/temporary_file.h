#pragma once
// A name beside a file under which its new contents are written until they replace it.

#include <filesystem>

namespace gi {

/// Holds ".NAME.tmp", locked while this object exists, so that a file which a killed program
/// left there is written anew by whoever writes NAME next. Where another process writes it now,
/// or files cannot be locked, the name is ".NAME.tmp-PID".
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
