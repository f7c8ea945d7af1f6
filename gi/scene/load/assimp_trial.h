#pragma once
// Trials of files that Assimp is to import. Some damaged files make it crash, loop or take all memory, so every
// file is first imported in a child process: with at most 5 s of processor time and 1 s more per MiB of the file,
// and 1 GiB of memory and 64 times the file's size.

#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/child_process.h"

#include <deque>
#include <map>
#include <optional>

namespace gi {

struct AssimpTrial {
    std::filesystem::path file;
    AssimpFaces faces;
    std::uint64_t file_bytes;
};

/// Outcomes of trials, which import_assimp asks on this thread while this object lives (an inner one first). One
/// child process tries all files, as starting one takes longer than importing a small file, and is ahead of who
/// asks. After a file that ends the child, another child continues with the next.
class AssimpTrials {
public:
    /// Files that are missing, empty or no regular files are left out.
    AssimpTrials(std::vector<std::filesystem::path> const& files, AssimpFaces faces);
    ~AssimpTrials();
    AssimpTrials(AssimpTrials const&) = delete;
    AssimpTrials& operator=(AssimpTrials const&) = delete;

    /// Why a file cannot be imported, empty = it can; nothing if it is none of these files. Waits for its trial.
    /// Throws InputError if no process can be started.
    std::optional<std::string> outcome(std::filesystem::path const& file, AssimpFaces faces);
    /// The same of the trials on this thread.
    static std::optional<std::string> known_outcome(std::filesystem::path const& file, AssimpFaces faces);

private:
    void go_on();
    void first_ended(std::string why);

    AssimpFaces faces_;
    std::deque<AssimpTrial> left_;                ///< files whose outcome is not known yet, in the order of trials
    std::map<std::string, std::string> outcomes_; ///< by file
    std::optional<ChildProcess> child_;           ///< tries the files that are left
    std::string told_;                            ///< by the child, not understood yet
    int stalls_ = 0;                              ///< attempts at the first file left that stalled
    AssimpTrials* before_;
};

} // namespace gi
