#include "viewer/batch/from_command.h"

#include "gi/core/error.h"
#include "gi/core/text.h"
#include "viewer/base/frame_range.h"
#include "viewer/batch/command_words.h"
#include "viewer/batch/manifest.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <span>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;

bool stands_alone(fs::path const& file)
{
    static std::set<std::string> const kAlone{".glb", ".stl", ".hdr", ".exr", ".png", ".jpg", ".csv", ".json"};
    return kAlone.contains(file.extension().string());
}

/// Makes the files that the words name inputs, by their whole paths: those of a scene too that refers to others.
/// @param names  number of words that name the command, not files
std::vector<int> find_inputs(CommandWords& words, std::ptrdiff_t names, std::set<std::string> const& outputs,
                             Batch& batch)
{
    InputFinder finder(batch, fs::current_path());
    std::set<int> found;
    bool is_scene = true; // the first file that is named
    for (std::string& word : std::span(words.all()).subspan(std::size_t(names))) {
        std::size_t const equals = word.starts_with("--") ? word.find('=') : word.npos;
        std::string const name = equals == word.npos ? word : word.substr(equals + 1);
        std::error_code none;
        if (name.empty() || outputs.contains(name) || !fs::exists(name, none)) continue;
        fs::path const path = fs::canonical(name);
        word = (equals == word.npos ? "" : word.substr(0, equals + 1)) + path.string();
        bool const takes_folder = is_scene && fs::is_regular_file(path, none) && !stands_alone(path);
        is_scene = false;
        for (int const i : finder.find((takes_folder ? path.parent_path() : path).string())) found.insert(i);
    }
    return {found.begin(), found.end()};
}

void refuse(CommandWords const& words, char const* option, char const* why, char const* suggestion)
{
    if (words.has(option)) throw gi::InputError(std::string(option) + " in a batch", why, suggestion);
}

/// "cornell" of "data/cornell.glb": for names of folders.
std::string stem_of(std::string const& scene) { return fs::path(scene).stem().string(); }

} // namespace

Batch batch_of_render(std::vector<std::string> const& given, int frames_per_task)
{
    CommandWords words(given);
    auto const frames = words.value("--frames");
    if (!frames)
        throw gi::InputError("render without --frames in a batch", "one picture is one task",
                             "add --frames 0:120@30, or render it with lightwell render");
    refuse(words, "--reuse", "a frame reuses light of earlier frames, which other tasks render", "leave it out");
    refuse(words, "--resume", "finished tasks are never done again anyway", "leave it out");
    refuse(words, "--video", "the video is made from all frames",
           "gather the frames and encode them, e.g. ffmpeg -i f_%04d.png");
    refuse(words, "--stats", "each task would write it", "leave it out; batch status tells times");
    FrameRange const all = parse_frame_range(*frames);
    std::string const rate = frames->substr(frames->find('@'));
    std::vector<FrameName> names;
    std::set<std::string> outputs;
    for (char const* const option : {"--out", "--png"}) {
        auto const pattern = words.value(option);
        if (!pattern) continue;
        fs::path const name = *pattern;
        names.push_back(parse_frame_name(option, name.filename().string()));
        words.set(option, name.filename().string());
        outputs.insert(name.filename().string());
    }
    if (names.empty())
        throw gi::InputError("no --out or --png", "the frames have no names", "add --out f_%04d.exr");
    Batch batch;
    batch.name = "render";
    Task task;
    task.group = "render";
    task.inputs = find_inputs(words, 1, outputs, batch);
    for (int first = all.first; first < all.end; first += frames_per_task) {
        int const end = std::min(all.end, first + frames_per_task);
        words.set("--frames", fmt::format("{}:{}{}", first, end, rate));
        task.parameters = {{"frames", fmt::format("{}:{}", first, end)}};
        task.command = words.all();
        task.outputs.clear();
        for (FrameName const& name : names)
            for (int f = first; f < end; ++f) task.outputs.push_back(name.of(f));
        batch.tasks.push_back(task);
    }
    return batch;
}

Batch batch_of_bench(std::vector<std::string> const& given)
{
    CommandWords words(given);
    std::string const what = given.size() > 1 ? given[1] : "";
    if (what != "sweep" && what != "pictures")
        throw gi::InputError("bench " + what + " in a batch", "it is one measurement on one machine",
                             "bench sweep and bench pictures can be split by their scenes");
    std::string const option = what == "sweep" ? "--scene" : "--scenes";
    auto const scenes = words.value(option);
    if (!scenes)
        throw gi::InputError("bench " + what + " without " + option, "a batch has a task for each scene",
                             "name them: " + option + " cornell,atrium");
    refuse(words, "--resume", "finished tasks are never done again anyway", "leave it out");
    if (!words.value("--out")) throw gi::InputError("no --out", "the tables have no folder", "add --out " + what);
    Batch batch;
    batch.name = "bench";
    batch.merges = {{"bench", what + ".csv"}};
    for (std::string_view const part : gi::split_at_commas(*scenes)) {
        std::string const scene(part);
        CommandWords one = words;
        one.set(option, scene);
        one.set("--out", stem_of(scene));
        Task task;
        task.group = "bench";
        task.parameters = {{"of", stem_of(scene)}};
        task.resources.cores = Resources::kAllCores; // others beside it would disturb its times
        task.inputs = find_inputs(one, 2, {stem_of(scene)}, batch);
        task.command = one.all();
        task.outputs = {stem_of(scene) + "/"};
        for (Task const& other : batch.tasks)
            if (other.outputs == task.outputs)
                throw gi::InputError("two scenes are called '" + stem_of(scene) + "'",
                                     "their tables would be mixed", "measure them in batches of their own");
        batch.tasks.push_back(task);
    }
    return batch;
}

} // namespace viewer::batch
