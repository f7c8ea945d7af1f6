#pragma once
// Finds running processes by their command lines, to test what a batch starts and ends.

#include "tests/viewer/run_program.h"
#include "viewer/batch/worker_process.h"

namespace viewer::test {

enum class Workers { none, only };

/// Processes whose command line has the folder and all the parts, and whose name is that of workers, or is not.
inline std::vector<int> processes_with(std::filesystem::path const& folder, std::vector<std::string> const& parts,
                                       Workers which = Workers::none)
{
    std::vector<int> found;
    for (auto const& entry : std::filesystem::directory_iterator("/proc")) {
        std::string const name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != name.npos) continue;
        auto const read = [&](char const* file, char end) { // empty where the process ends meanwhile
            std::ifstream in(entry.path() / file, std::ios::binary);
            std::string text;
            std::getline(in, text, end);
            return text;
        };
        std::string const line = read("cmdline", '\xff');
        if (line.find(folder.string()) == line.npos) continue;
        bool const is_worker = read("comm", '\n') == batch::kWorkerName;
        if (is_worker != (which == Workers::only)) continue;
        if (std::ranges::all_of(parts, [&](std::string const& part) { return line.find(part) != line.npos; }))
            found.push_back(std::stoi(name));
    }
    return found;
}

/// Makes the Python of scripts/setup --tests that of batches; false if it has no HyperQueue.
inline bool has_hyperqueue()
{
    if (std::getenv("LIGHTWELL_PYTHON") == nullptr)
        setenv("LIGHTWELL_PYTHON", LIGHTWELL_SOURCE_DIR "/build/python/bin/python3", 1);
    return std::system("$LIGHTWELL_PYTHON -c 'import hyperqueue' 2> /dev/null") == 0;
}

} // namespace viewer::test
