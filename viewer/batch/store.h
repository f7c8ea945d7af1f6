#pragma once
// The folder of a batch's results. Any number of batches and machines may use one at the same time.
//
//   batches/NAME-1a2b3c4d   the plan of a batch: a line about all tasks, then one per task
//   batches/.NAME-1a2b3c4d.index   where its lines begin
//   objects/ab/cdef...      outputs, named by the SHA-256 of their content
//   results/ab/abcdef...    one file per finished task, named by its key: names and hashes of its outputs
//   journal/HOST.jsonl      what happened on each machine (journal.h)
//   claims/ab               locks of running tasks (claim.h)
//   work/abcdef...          the folder in which a task runs; abcdef....result: its result before that appears
//
// A result appears whole, by renaming, once its objects are on the disk. So a task is finished or it is not,
// whatever is killed and whenever; a result without its objects, or with a wrong checksum, counts as none. What
// was prepared but did not get that far is published later if it is whole.

#include "viewer/batch/task.h"

#include <functional>
#include <optional>

namespace viewer::batch {

struct Output {
    std::string name; ///< relative to the task's folder
    std::string sha256;
    std::uint64_t bytes = 0;
    bool is_new = false; ///< no task had made this content before; not kept
};

struct Result {
    std::string task; ///< key
    std::vector<Output> outputs;
    double seconds = 0;             ///< of the attempt that finished
    std::uint64_t memory_bytes = 0; ///< its peak
    int attempts = 1;
    std::string messages; ///< end of its stderr, where a program counts what it lost
    std::string host;
};

class Store {
public:
    /// @throws InputError it is no store, or of a newer version
    static Store open(std::filesystem::path const& folder);
    /// Opens it, or makes it. @throws InputError it cannot be made, or is a folder of something else
    static Store open_or_make(std::filesystem::path const& folder);

    std::filesystem::path const& folder() const { return folder_; }
    std::filesystem::path claims() const { return folder_ / "claims"; }
    std::filesystem::path journal() const { return folder_ / "journal"; }
    std::filesystem::path object(std::string const& sha256) const;
    std::filesystem::path work(std::string const& key) const { return folder_ / "work" / key; }
    /// The result of a finished task.
    std::optional<Result> result(std::string const& key) const;
    /// Moves the outputs of a task to the objects and writes its result, which does not count yet.
    /// @param result without hashes and sizes, which are filled in
    void prepare(Result& result) const;
    /// Makes a prepared task finished: hands its outputs and the journal to the disk, and lets the result appear.
    void publish(std::string const& key) const;
    /// Removes what could not be published, and its new objects: nobody knows what of them reached the disk.
    void withdraw(Result const& prepared) const;
    /// Publishes what a process prepared before it was killed, if every byte of it is there. If not, it is removed
    /// with its damaged objects, which the next attempt would take for its own. For holders of the task's claim.
    /// @return the result @throws InputError it cannot be published
    std::optional<Result> recover(std::string const& key) const;
    /// Forgets a result, one of whose objects is damaged, and that object.
    void forget(std::string const& key, std::string const& object_sha256) const;

    /// Keeps the plan of a batch. @return its id: name and hash of its tasks
    std::string keep(Batch const& batch) const;
    /// Ids, the newest first.
    std::vector<std::string> batches() const;
    /// The id that was asked for, or the newest; NAME alone means its newest. @throws InputError there is none
    std::string find_batch(std::string const& wanted) const;
    Batch batch(std::string const& id) const;
    /// The batch with one task alone. @param index from 0 @throws InputError there is no such task
    Batch batch_of_task(std::string const& id, std::size_t index) const;

private:
    explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}
    std::filesystem::path result_file(std::string const& key) const;
    std::filesystem::path prepared_file(std::string const& key) const;

    std::filesystem::path folder_; ///< absolute
};

} // namespace viewer::batch
