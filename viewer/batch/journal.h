#pragma once
// What happened in a store, one line per event (gi/core/checked_line.h), appended by any number of processes: each
// machine has its own file, named by its host name. Results say what is finished; the journal says how it came to
// be, why attempts failed, and what runs.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace viewer::batch {

enum class EventKind { started, finished, failed, interrupted };

struct Event {
    EventKind kind = EventKind::started;
    std::string task; ///< key
    int attempt = 1;
    double at_s = 0;      ///< since 1970
    double seconds = 0;   ///< that the attempt took
    std::string why;      ///< of a failure: "exit code 1", "SIGSEGV", "longer than 10 s", ...
    std::string messages; ///< end of its stderr
    std::string host;     ///< on reading: from the file's name
    int process = 0;      ///< that ran it
};

class TaskJournal {
public:
    /// @param folder of the journals; this machine's is made if it is missing
    explicit TaskJournal(std::filesystem::path const& folder);
    ~TaskJournal();
    TaskJournal(TaskJournal const&) = delete;
    TaskJournal& operator=(TaskJournal const&) = delete;

    /// One write to the file: other processes see the whole line or nothing. Time and process are filled in. An
    /// incomplete line that a killed process left before it is ended first.
    void append(Event event);

private:
    std::filesystem::path file_;
    int fd_ = -1;
};

/// Reads the journals of all machines; each call continues where the last one ended.
class TaskJournalReader {
public:
    explicit TaskJournalReader(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// In the order of each machine's file. A last line that is still being written is left for the next call.
    std::vector<Event> read();
    /// Lines that were incomplete or changed.
    std::size_t damaged() const { return damaged_; }

private:
    std::filesystem::path folder_;
    std::map<std::filesystem::path, std::uintmax_t> read_; ///< bytes, by file
    std::size_t damaged_ = 0;
};

} // namespace viewer::batch
