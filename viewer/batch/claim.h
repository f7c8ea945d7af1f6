#pragma once
// The right to run a task: at most one process on any machine has it. It is a lock on one byte of a file in
// the store, which the kernel releases when its holder ends in whatever way, so that none is left behind.
// A store that machines share therefore has to be on a file system that locks for all of them
// (NFS 4, Lustre with -o flock, ...).

#include <filesystem>
#include <string>
#include <utility>

namespace viewer::batch {

class Claim {
public:
    /// @param folder of the lock files  @param key of the task, hexadecimal
    Claim(std::filesystem::path const& folder, std::string const& key);
    ~Claim(); ///< gives it up
    Claim(Claim const&) = delete;
    Claim& operator=(Claim const&) = delete;

    /// Takes it without waiting; false if another process has it.
    bool take();
    /// True if another process has it.
    bool is_taken_elsewhere() const;

private:
    int fd_ = -1;
    long long at_ = 0;
};

} // namespace viewer::batch
