#pragma once
// The journal file of a session, to which a line is appended per entry. The line is on the disk (fdatasync) when
// append returns. Lines are written into space preallocated as empty lines at the end of the file: if the file's
// length does not change, the write need not wait for the file system's journal or for writes of others. Without
// preallocated space (a full disk) the file grows line by line.

#include "study/journal/journal_file.h"

namespace study {

class Journal {
public:
    /// Creates a file and locks it for this process. @throws ScriptError if it exists or cannot be created
    static Journal create(std::filesystem::path const& file);
    /// Opens an existing file: locks it, reads it, and cuts off an incomplete last line.
    /// @param found its content @throws ScriptError if another process uses it, or it cannot be read or written
    static Journal open(std::filesystem::path const& file, JournalText& found);

    ~Journal();
    Journal(Journal&& other) noexcept;
    Journal(Journal const&) = delete;
    Journal& operator=(Journal const&) = delete;

    /// @throws ScriptError if the entry cannot be stored (a full disk, ...): earlier entries are unchanged, and
    /// this object writes nothing any more
    void append(JournalEntry const& entry);
    double synced_ms() const { return synced_ms_; } ///< total time spent waiting for the disk

private:
    Journal(std::filesystem::path file, int descriptor);
    void make_room(std::size_t bytes);
    [[noreturn]] void fail(int error);

    std::filesystem::path file_;
    int fd_ = -1;
    std::size_t size_ = 0; ///< bytes of complete lines
    std::size_t room_ = 0; ///< bytes including the empty lines
    int lines_ = 0;
    bool has_failed_ = false;
    double synced_ms_ = 0;
};

} // namespace study
