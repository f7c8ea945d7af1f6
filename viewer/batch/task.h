#pragma once
// A task of a batch: one command line of lightwell, the files it reads, and the files it makes.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace viewer::batch {

/// What a task occupies while it runs.
struct Resources {
    static constexpr int kAllCores = 0;

    int cores = 1; ///< or kAllCores: the whole machine
    int gpus = 0;
    std::uint64_t memory_bytes = 0; ///< at most; 0 = unlimited

    bool operator==(Resources const&) const = default;
};

/// A file that tasks read.
struct InputFile {
    std::string name;           ///< as commands name it: relative to the manifest, or absolute
    std::filesystem::path path; ///< absolute
    std::string sha256;
    std::uint64_t bytes = 0;
    std::int64_t changed_ns = 0; ///< modification time when it was hashed
};

/// The value of a parameter, e.g. {"scene", "atrium"}.
using Parameter = std::pair<std::string, std::string>;

struct Task {
    std::string key;   ///< identity, see key_of()
    std::string group; ///< of the manifest
    std::vector<Parameter> parameters;
    std::vector<std::string> command; ///< words after `lightwell`
    std::vector<int> inputs;          ///< indices of Batch::files
    std::vector<std::string> outputs; ///< relative to the task's folder; a name that ends with / is a folder
    std::string standard_output;      ///< the output that stdout is written to; empty = none
    Resources resources;
    int retries = 1;    ///< further attempts after a failure
    double limit_s = 0; ///< of an attempt; 0 = unlimited
};

/// Tables or lines of a group's tasks that are joined to one file.
struct Merge {
    std::string group, file;
};

struct Batch {
    std::string name;
    std::string program; ///< which made the plan, and has to run it (program_identity())
    std::vector<InputFile> files;
    std::vector<Merge> merges;
    std::vector<Task> tasks;
};

/// What makes a task the same as another one, in any batch: SHA-256 of its command, of the names and contents of
/// its inputs, of the names of its outputs, and of the program.
std::string key_of(Task const& task, Batch const& batch);
/// Fills in the keys of all tasks.
void give_keys(Batch& batch);
/// "methods scene=atrium paths=4", for messages.
std::string title_of(Task const& task);

/// Version of this program; of a build from changed sources, whose version does not tell it from another one, also
/// a hash of the sizes and times of all programs. @param folder where the programs are
std::string program_identity(std::filesystem::path const& folder);
/// The folder of the running program.
std::filesystem::path program_folder();

} // namespace viewer::batch
