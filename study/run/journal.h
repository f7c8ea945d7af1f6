#pragma once
// The file that a session grows by, line after line. A line is on the disk (fdatasync) when append returns. Lines
// are written into room that was made for them, empty lines at the end of the file: a file whose length does not
// change need not wait for the file system's own journal, nor for what others write. Without room (a full disk) it
// grows line by line.

#include "study/journal/journal_file.h"

namespace study {

class Journal {
public:
    /// A new file, locked for this process. @throws ScriptError where there is one or none can be made
    static Journal create(std::filesystem::path const& file);
    /// One that is there: locked, read, its torn end cut off.
    /// @param found what it says @throws ScriptError where another process has it, or it cannot be read or written
    static Journal open(std::filesystem::path const& file, JournalText& found);

    ~Journal();
    Journal(Journal&& other) noexcept;
    Journal(Journal const&) = delete;
    Journal& operator=(Journal const&) = delete;

    /// @throws ScriptError where it cannot be kept (a full disk, ...): what was there before is as it was, and
    /// nothing is written by this object any more
    void append(JournalEntry const& entry);
    double synced_ms() const { return synced_ms_; } ///< spent waiting for the disk, all together

private:
    Journal(std::filesystem::path file, int descriptor);
    void make_room(std::size_t bytes);
    [[noreturn]] void fail(int error);

    std::filesystem::path file_;
    int fd_ = -1;
    std::size_t size_ = 0; ///< of whole lines
    std::size_t room_ = 0; ///< with the empty ones
    int lines_ = 0;
    bool has_failed_ = false;
    double synced_ms_ = 0;
};

} // namespace study
