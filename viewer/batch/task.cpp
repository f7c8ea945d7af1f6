#include "viewer/batch/task.h"

#include "gi/core/error.h"
#include "gi/core/processor_level.h"
#include "gi/core/sha256.h"
#include "viewer/base/version.h"
#include "viewer/batch/file_hash.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace viewer::batch {

namespace fs = std::filesystem;

std::string key_of(Task const& task, Batch const& batch)
{
    nlohmann::ordered_json j{{"format", "task/1"},
                             {"program", batch.program},
                             {"command", task.command},
                             {"outputs", task.outputs},
                             {"stdout", task.standard_output}};
    for (int const i : task.inputs) {
        InputFile const& file = batch.files[std::size_t(i)];
        j["inputs"].push_back({file.name, file.sha256});
    }
    return gi::sha256(j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void give_keys(Batch& batch)
{
    for (Task& task : batch.tasks) task.key = key_of(task, batch);
}

std::string title_of(Task const& task)
{
    std::string title = task.group;
    for (auto const& [name, value] : task.parameters) title += " " + name + "=" + value;
    return title;
}

fs::path program_folder()
{
    std::error_code failed;
    fs::path const self = fs::read_symlink("/proc/self/exe", failed);
    if (failed) throw gi::InputError("the program's folder is unknown", failed.message(), "mount /proc");
    return self.parent_path();
}

std::string program_identity(fs::path const& folder)
{
    std::string version = version_text();
    // Which programs lightwell starts for tasks (viewer/cli/main/lightwell.cpp).
    char const* const level = std::getenv("LIGHTWELL_LEVEL");
    if (level != nullptr && std::string_view(level) != gi::kCompiledLevel)
        version += ", tasks by " + std::string(level);
    if (version.find("-dirty") == version.npos && version.find("unknown") == version.npos) return version;
    std::vector<fs::path> programs, folders{folder};
    for (char const* const of_level : gi::kProcessorLevels) folders.push_back(folder / of_level);
    std::error_code none;
    for (fs::path const& in : folders)
        for (auto const& entry : fs::directory_iterator(in, none))
            if (entry.is_regular_file() && entry.path().filename().string().starts_with("lightwell-"))
                programs.push_back(entry.path());
    std::ranges::sort(programs);
    std::string all;
    for (fs::path const& program : programs) {
        std::error_code failed; // sizes and times: hashing all programs would take a second
        all += program.filename().string() + " " + std::to_string(fs::file_size(program, failed)) + " " +
               std::to_string(fs::last_write_time(program, failed).time_since_epoch().count()) + "\n";
    }
    return version + " " + gi::sha256(all).substr(0, 16);
}

} // namespace viewer::batch
