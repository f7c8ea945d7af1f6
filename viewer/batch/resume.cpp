#include "viewer/batch/resume.h"

#include "gi/methods/names.h"
#include "viewer/batch/command_words.h"

namespace viewer::batch {
namespace {

/// The other methods, and radiance caches, start their light afresh when a picture is resumed.
bool resumes_exactly(CommandWords const& words)
{
    std::string const method = words.value("--method").value_or(std::string(gi::kDefaultMethod));
    return gi::resumes_exactly(method) &&
           words.value("--radiance-cache").value_or("off") == "off";
}

} // namespace

std::vector<std::string> resumable_files(Task const& task)
{
    CommandWords const words(task.command);
    if (task.command.empty() || task.command.front() != "render") return {};
    // A budget counts for each call, motion blur is rendered in one go, frames of a chain differ in their noise,
    // and reports of frames are only of those that a call rendered.
    for (char const* const option :
         {"--resume", "--budget", "--shutter", "--reuse", "--video", "--stats", "--json"})
        if (words.has(option)) return {};
    auto const out = words.value("--out"), png = words.value("--png"), state = words.value("--state");
    std::vector<std::string> files;
    if (words.has("--frames")) {
        if (words.has("--half") && png)
            return {}; // a PNG of a frame that is kept would be made from its half floats
        for (std::string const& output : task.outputs)
            if (out && output.ends_with(".exr")) files.push_back(output);
    } else if (resumes_exactly(words) && (state || out || png)) {
        files.push_back(state ? *state : (out ? *out : *png) + ".state");
    }
    for (std::string& file : files) {
        std::filesystem::path const name = std::filesystem::path(file).lexically_normal();
        if (name.is_absolute() || *name.begin() == "..") return {}; // it may be that of another task
        file = name.string();
    }
    return files;
}

} // namespace viewer::batch
