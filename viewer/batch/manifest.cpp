#include "viewer/batch/manifest.h"

#include "gi/core/edit_distance.h"
#include "gi/core/text.h"
#include "viewer/base/arguments.h"
#include "viewer/base/frame_range.h"
#include "viewer/batch/file_hash.h"
#include "viewer/batch/former_command.h"
#include "viewer/batch/placeholders.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <set>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTasks = 1'000'000;

/// Keys that say how tasks run: for the whole manifest, or of a group.
std::vector<std::string> const kHow{"retries", "limit", "cores", "gpus", "memory"};

std::vector<std::string> with_how(std::vector<std::string> keys)
{
    keys.insert(keys.end(), kHow.begin(), kHow.end());
    return keys;
}

std::uint64_t bytes_of(gi::Yaml const& y)
{
    std::string const text = y.text();
    static std::map<std::string, double> const kUnits{
        {"MB", 1e6}, {"GB", 1e9}, {"MiB", 1048576.0}, {"GiB", 1073741824.0}};
    std::size_t const unit = text.find_first_not_of("0123456789.");
    auto const number = gi::parse_finite(std::string_view(text).substr(0, unit));
    auto const found = unit == text.npos
                           ? kUnits.end()
                           : kUnits.find(std::string(gi::trimmed(std::string_view(text).substr(unit))));
    if (!number || found == kUnits.end() || !(*number > 0) || *number * found->second > 1e15)
        throw y.error("'" + text + "' is no amount of memory", "a number and a unit are needed",
                      "write 4GiB or 500MB");
    return std::uint64_t(*number * found->second);
}

double seconds_of(gi::Yaml const& y)
{
    try {
        return parse_duration("limit", y.text());
    } catch (gi::InputError const& e) {
        throw y.error(e.problem(), e.why(), e.suggestion());
    }
}

/// "1..20" as numbers; nothing if the text is no such range.
std::optional<std::vector<std::string>> numbers_of_range(std::string const& text)
{
    std::size_t const dots = text.find("..");
    if (dots == text.npos) return std::nullopt;
    auto const first = gi::parse_number<long long>(std::string_view(text).substr(0, dots));
    auto const last = gi::parse_number<long long>(std::string_view(text).substr(dots + 2));
    if (!first || !last || *last < *first || *last - *first >= (long long)(kMostTasks)) return std::nullopt;
    std::vector<std::string> out;
    for (long long i = *first; i <= *last; ++i) out.push_back(std::to_string(i));
    return out;
}

/// Values of a parameter: a list, one value, or a range such as 1..20.
std::vector<std::string> values_of(gi::Yaml const& y)
{
    std::vector<std::string> out;
    for (gi::Yaml const& item : y.one_or_more()) {
        if (auto const range = numbers_of_range(item.text()))
            out.insert(out.end(), range->begin(), range->end());
        else
            out.push_back(item.text());
    }
    if (out.empty()) throw y.error(y.path() + " is empty", "there would be no task", "name a value");
    return out;
}

/// Relative, within the task's folder.
void check_output(std::string const& name, gi::Yaml const& where)
{
    fs::path const path = name;
    bool const leaves = std::ranges::any_of(path, [](fs::path const& part) { return part == ".."; });
    if (name.empty() || path.is_absolute() || leaves)
        throw where.error("'" + name + "' cannot be an output",
                          "outputs are named within the folder of their task",
                          "write a name such as pictures/a.exr; batch gather puts it where you want it");
}

class Reader {
public:
    Reader(ReadManifest& out, fs::path const& folder, std::vector<std::string> const& commands)
        : m_(out.mistakes), batch_(out.batch), commands_(commands), finder_(out.batch, folder)
    {
    }

    void read(gi::Yaml const& y)
    {
        m_.check_keys(y, with_how({"schema", "batch", "sequences", "sweeps", "stimuli", "simulated"}));
        m_.take(y, "schema", [&](gi::Yaml const& v) {
            if (v.text() != "batch/1" && v.text() != "batch/2") throw v.unknown("known schema", {"batch/2", "batch/1"});
            is_of_0_1_ = v.text() == "batch/1";
        });
        m_.need(y, "batch", "example", [&](gi::Yaml const& v) { batch_.name = v.name(); });
        Task usual;
        read_how(y, usual);
        groups(y, "sequences", [&](std::string const& n, gi::Yaml const& g) { read_sequence(n, g, usual); });
        groups(y, "sweeps", [&](std::string const& n, gi::Yaml const& g) { read_sweep(n, g, usual); });
        groups(y, "stimuli", [&](std::string const& n, gi::Yaml const& g) { read_stimuli(n, g, usual); });
        groups(y, "simulated", [&](std::string const& n, gi::Yaml const& g) { read_simulated(n, g, usual); });
        if (m_.empty() && batch_.tasks.empty())
            m_.add(y.error("the batch has no tasks", "it has no group",
                           "add sequences, sweeps, stimuli or simulated (docs/batch.md)"));
    }

private:
    void groups(gi::Yaml const& y, char const* kind,
                std::function<void(std::string const&, gi::Yaml const&)> const& read)
    {
        m_.take(y, kind, [&](gi::Yaml const& all) {
            for (auto const& [key, group] : m_.entries(all))
                m_.attempt([&, &key = key, &group = group] { // clang 14 cannot capture the names themselves
                    std::string const name = key.name();
                    if (!groups_.insert(name).second)
                        throw key.error("there are two groups '" + name + "'", "their outputs would be mixed",
                                        "rename one");
                    read(name, group);
                });
        });
    }

    void read_how(gi::Yaml const& y, Task& t)
    {
        m_.take(y, "retries", [&](gi::Yaml const& v) { t.retries = int(v.integer(0, 100)); });
        m_.take(y, "limit", [&](gi::Yaml const& v) { t.limit_s = seconds_of(v); });
        m_.take(y, "gpus", [&](gi::Yaml const& v) { t.resources.gpus = int(v.integer(0, 64)); });
        m_.take(y, "memory", [&](gi::Yaml const& v) { t.resources.memory_bytes = bytes_of(v); });
        m_.take(y, "cores", [&](gi::Yaml const& v) {
            t.resources.cores = v.is_text() && v.text() == "all" ? Resources::kAllCores : int(v.integer(1, 4096));
        });
    }

    void add_input(Task& t, std::string const& name, gi::Yaml const& where)
    {
        try {
            for (int const i : finder_.find(name))
                if (std::ranges::find(t.inputs, i) == t.inputs.end()) t.inputs.push_back(i);
        } catch (gi::InputError const& e) {
            throw where.error(e.problem(), e.why(), e.suggestion());
        }
    }

    void add(Task const& t, gi::Yaml const& where)
    {
        if (batch_.tasks.size() == kMostTasks)
            throw where.error(fmt::format("the batch has more than {} tasks", kMostTasks), "no plan is that large",
                              "make several manifests; they can share one store");
        for (std::string const& output : t.outputs) {
            bool const is_folder = output.ends_with('/');
            if (!is_folder && !outputs_.insert(t.group + "/" + output).second)
                throw where.error("two tasks have the output '" + output + "'", "one would replace the other",
                                  "name it with a {parameter} in which they differ");
        }
        batch_.tasks.push_back(t);
        if (is_of_0_1_) batch_.tasks.back().command = current_command(t.command);
    }

    /// The words of a command: a list, or a text split at blanks.
    std::vector<std::string> words_of(gi::Yaml const& y)
    {
        std::vector<std::string> words;
        if (y.is_list()) {
            for (gi::Yaml const& item : y.items(1)) words.push_back(item.text());
        } else {
            std::string const text = y.text();
            if (text.find_first_of("'\"\\$;|&<>`") != text.npos)
                throw y.error("the command '" + gi::shortened(text, 60) + "' has signs of a shell",
                              "no shell reads it: it is split at blanks",
                              "write a list of words, each as the program gets it: [render, scene.yaml, ...]");
            std::string_view rest = text;
            for (std::string_view word; !(word = gi::take_word(rest)).empty();) words.emplace_back(word);
        }
        if (!words.empty() && words.front() == "lightwell") words.erase(words.begin());
        if (words.empty()) throw y.error("the command is empty", "it names what a task does", "write render ...");
        if (std::ranges::find(commands_, words.front()) == commands_.end())
            throw y.error("there is no command '" + words.front() + "'", "tasks are command lines of lightwell",
                          gi::suggest(words.front(), commands_));
        return words;
    }

    struct Template {
        std::vector<std::string> command;
        std::vector<std::pair<std::string, gi::Yaml>> outputs, inputs;
        std::optional<gi::Yaml> command_place, standard_output;
    };

    /// @return whether it is complete
    bool read_template(gi::Yaml const& y, Template& t, char const* example)
    {
        bool const has_command = m_.need(y, "command", example, [&](gi::Yaml const& v) {
            t.command = words_of(v);
            t.command_place = v;
        });
        m_.take(y, "stdout", [&](gi::Yaml const& v) { t.standard_output = v; });
        bool const has_outputs = (t.standard_output && !y.has("outputs")) ||
                                 m_.need(y, "outputs", "[picture.exr]", [&](gi::Yaml const& v) {
                                     for (gi::Yaml const& item : v.one_or_more())
                                         t.outputs.emplace_back(item.text(), item);
                                 });
        return has_command && has_outputs;
    }

    void read_merge(gi::Yaml const& y, std::string const& group)
    {
        m_.take(y, "merge", [&](gi::Yaml const& v) {
            for (gi::Yaml const& item : v.one_or_more()) {
                check_output(item.text(), item);
                std::string const ending = fs::path(item.text()).extension().string();
                if (ending != ".csv" && ending != ".tsv" && ending != ".jsonl")
                    throw item.error("'" + item.text() + "' cannot be merged",
                                     "tables (.csv, .tsv) and lines of JSON (.jsonl) can",
                                     "give it such an ending");
                batch_.merges.push_back({group, item.text()});
            }
        });
    }

    void fill(Task& t, Template const& from)
    {
        for (std::string const& word : from.command)
            t.command.push_back(filled_in(word, t.parameters, *from.command_place));
        for (auto const& [text, where] : from.outputs) t.outputs.push_back(filled_in(text, t.parameters, where));
        if (from.standard_output) {
            t.standard_output = filled_in(from.standard_output->text(), t.parameters, *from.standard_output);
            t.outputs.push_back(t.standard_output);
        }
        for (std::size_t i = 0; i < t.outputs.size(); ++i)
            check_output(t.outputs[i], i < from.outputs.size() ? from.outputs[i].second : *from.standard_output);
        for (auto const& [text, where] : from.inputs) add_input(t, filled_in(text, t.parameters, where), where);
    }

    /// Inputs that name parameters belong to single tasks; the others to the whole group.
    Task read_inputs(std::string const& name, gi::Yaml const& y, Task const& usual, Template& from)
    {
        Task t = usual;
        t.group = name;
        read_how(y, t);
        m_.take(y, "inputs", [&](gi::Yaml const& v) {
            for (gi::Yaml const& item : v.one_or_more()) {
                if (item.text().find('{') != std::string::npos)
                    from.inputs.emplace_back(item.text(), item);
                else
                    m_.attempt([&] { add_input(t, item.text(), item); });
            }
        });
        return t;
    }

    void read_sweep(std::string const& name, gi::Yaml const& y, Task const& usual)
    {
        m_.check_keys(y, with_how({"command", "over", "combine", "inputs", "outputs", "stdout", "merge"}));
        Template from;
        Task const common = read_inputs(name, y, usual, from);
        bool complete = read_template(y, from, "render {scene} --paths {paths} --out picture.exr");
        read_merge(y, name);
        bool zips = false;
        m_.take(y, "combine", [&](gi::Yaml const& v) {
            zips = v.one_of({"product", "zip"}, "way to combine") == 1;
        });
        std::vector<std::pair<std::string, std::vector<std::string>>> over;
        complete = m_.need(y, "over", "{paths: [1, 4, 16]}", [&](gi::Yaml const& v) {
            for (auto const& [key, values] : m_.entries(v))
                complete = m_.attempt([&, &key = key, &values = values] {
                    over.emplace_back(key.name(), values_of(values));
                }) && complete;
            for (auto const& [parameter, values] : over)
                if (zips && values.size() != over.front().second.size())
                    throw v.error(fmt::format("'{}' has {} values, '{}' has {}", over.front().first,
                                              over.front().second.size(), parameter, values.size()),
                                  "with combine: zip the first values make a task, the second ones, and so on",
                                  "give all as many, or leave combine out for all combinations");
        }) && complete;
        if (!complete || over.empty()) return;
        double count = 1; // as a product may be beyond any integer
        for (auto const& [parameter, values] : over)
            count = zips ? double(values.size()) : count * double(values.size());
        if (count > double(kMostTasks))
            throw y.at("over").error(fmt::format("the sweep has {:.3g} tasks", count),
                                     fmt::format("at most {} are possible", kMostTasks), "name fewer values");
        for (std::size_t i = 0; i < std::size_t(count); ++i) {
            Task t = common;
            std::size_t rest = i, block = std::size_t(count);
            for (auto const& [parameter, values] : over) {
                block /= zips ? 1 : values.size();
                t.parameters.emplace_back(parameter, values[zips ? i : rest / block]);
                if (!zips) rest %= block;
            }
            fill(t, from);
            add(t, *from.command_place);
        }
    }

    void read_sequence(std::string const& name, gi::Yaml const& y, Task const& usual)
    {
        m_.check_keys(y, with_how({"command", "frames", "frames_per_task", "inputs", "outputs", "merge"}));
        Template from;
        Task const common = read_inputs(name, y, usual, from);
        bool complete = read_template(y, from, "render atrium --frames {frames} --out f_%04d.exr");
        read_merge(y, name);
        FrameRange all;
        std::string rate;
        complete = m_.need(y, "frames", "0:120@30", [&](gi::Yaml const& v) {
            try {
                all = parse_frame_range(v.text());
                rate = v.text().substr(v.text().find('@'));
            } catch (gi::InputError const& e) {
                throw v.error(e.problem(), e.why(), e.suggestion());
            }
        }) && complete;
        int length = 1;
        m_.take(y, "frames_per_task", [&](gi::Yaml const& v) { length = int(v.integer(1, 100000)); });
        if (!complete) return;
        if (std::ranges::none_of(from.command, [](std::string const& w) { return w.find("{frames}") != w.npos; }))
            throw from.command_place->error("the command does not use {frames}", "all tasks would be the same",
                                            "add --frames {frames}");
        for (int first = all.first; first < all.end; first += length) {
            int const end = std::min(all.end, first + length);
            Task t = common;
            t.parameters = {{"frames", fmt::format("{}:{}{}", first, end, rate)}};
            fill(t, from);
            std::vector<std::string> outputs;
            for (std::size_t i = 0; i < t.outputs.size(); ++i) {
                if (t.outputs[i].find('%') == std::string::npos) {
                    outputs.push_back(t.outputs[i]);
                    continue;
                }
                try {
                    FrameName const frame_name = parse_frame_name("outputs", t.outputs[i]);
                    for (int f = first; f < end; ++f) outputs.push_back(frame_name.of(f));
                } catch (gi::InputError const& e) {
                    throw from.outputs[i].second.error(e.problem(), e.why(), e.suggestion());
                }
            }
            t.outputs = outputs;
            add(t, *from.command_place);
        }
    }

    /// Adds `--name value` for a key that is there.
    void add_option(gi::Yaml const& y, char const* key, char const* option, std::vector<std::string>& words)
    {
        m_.take(y, key, [&](gi::Yaml const& v) {
            words.emplace_back(option);
            words.push_back(v.text());
        });
    }

    /// The script of an experiment and files that are given by further keys, as inputs. @return the script's name
    std::string read_script(gi::Yaml const& y, Task& t, std::vector<char const*> const& files)
    {
        std::string script;
        m_.need(y, "script", "study.yaml", [&](gi::Yaml const& v) {
            add_input(t, v.text(), v);
            script = v.text();
        });
        for (char const* const key : files) m_.take(y, key, [&](gi::Yaml const& v) { add_input(t, v.text(), v); });
        return script;
    }

    void read_stimuli(std::string const& name, gi::Yaml const& y, Task const& usual)
    {
        m_.check_keys(y, with_how({"script", "size", "font", "display_model", "parts", "inputs"}));
        Template unused;
        Task t = read_inputs(name, y, usual, unused);
        std::string const script = read_script(y, t, {"display_model"});
        int parts = 1;
        m_.need(y, "parts", "8", [&](gi::Yaml const& v) { parts = int(v.integer(1, 100000)); });
        t.command = {"study", "prepare", script};
        add_option(y, "size", "--size", t.command);
        add_option(y, "font", "--font", t.command);
        add_option(y, "display_model", "--display-model", t.command);
        t.command.insert(t.command.end(), {"--out", "stimuli", "--part", ""});
        t.outputs = {"stimuli/"};
        for (int i = 1; i <= parts; ++i) {
            t.command.back() = fmt::format("{}/{}", i, parts);
            t.parameters = {{"part", t.command.back()}};
            add(t, y);
        }
    }

    void read_simulated(std::string const& name, gi::Yaml const& y, Task const& usual)
    {
        m_.check_keys(y, with_how({"script", "seeds", "participants", "observer", "inputs"}));
        Template unused;
        Task t = read_inputs(name, y, usual, unused);
        std::string const script = read_script(y, t, {"observer"});
        std::vector<std::string> seeds;
        m_.need(y, "seeds", "1..20", [&](gi::Yaml const& v) { seeds = values_of(v); });
        std::vector<std::string> words{"study", "simulate", script};
        add_option(y, "participants", "--participants", words);
        add_option(y, "observer", "--observer", words);
        for (std::string const& seed : seeds) {
            std::string const folder = "seed-" + seed;
            t.command = words;
            t.command.insert(t.command.end(), {"--seed", seed, "--out", folder});
            t.parameters = {{"seed", seed}};
            t.outputs = {folder + "/"};
            add(t, y);
        }
    }

    gi::Mistakes& m_;
    Batch& batch_;
    std::vector<std::string> const& commands_;
    InputFinder finder_;
    bool is_of_0_1_ = true; ///< for whose methods the commands were written
    std::set<std::string> groups_, outputs_;
};

} // namespace

std::vector<int> InputFinder::find(std::string const& name)
{
    fs::path const given = name, path = folder_ / given;
    bool const leaves = std::ranges::any_of(given, [](fs::path const& part) { return part == ".."; });
    if (leaves)
        throw gi::InputError("'" + name + "' cannot be an input", "tasks run in a folder of their own",
                             "name a file in the manifest's folder or below it, or write the whole path from /");
    std::error_code none;
    if (!fs::exists(path, none))
        throw gi::InputError("there is no input '" + path.string() + "'", "tasks read it", "check the path");
    if (!fs::is_directory(path, none)) return {index_of(name, path)};
    std::vector<fs::path> files;
    for (auto const& entry : fs::recursive_directory_iterator(path))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    if (files.empty())
        throw gi::InputError("the input '" + path.string() + "' is an empty folder", "tasks read it",
                             "check the path");
    std::vector<int> found;
    for (fs::path const& file : files)
        found.push_back(index_of((given / file.lexically_relative(path)).string(), file));
    return found;
}

int InputFinder::index_of(std::string const& name, fs::path const& path)
{
    auto const [known, is_new] = known_.try_emplace(name, int(batch_.files.size()));
    if (!is_new) return known->second;
    fs::path const real = fs::canonical(path);
    batch_.files.push_back({name, real, file_sha256(real), fs::file_size(real), changed_ns(real)});
    return known->second;
}

ReadManifest read_manifest(std::string const& text, std::string const& file,
                           std::vector<std::string> const& commands)
{
    ReadManifest out;
    out.mistakes.attempt([&] {
        fs::path const folder = fs::absolute(file).parent_path();
        Reader(out, folder, commands).read(gi::Yaml::parse(text, file, "manifest"));
    });
    return out;
}

} // namespace viewer::batch
