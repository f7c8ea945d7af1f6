#include "viewer/batch/batch_file.h"

#include "gi/core/checked_line.h"
#include "gi/core/error.h"
#include "gi/core/sha256.h"
#include "gi/core/text.h"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace viewer::batch {
namespace {

using Json = nlohmann::ordered_json;

constexpr char const* kPlanFormat = "batch/1";
constexpr int kIndexBytes = 17; ///< of a line of the index

std::string line(Json const& j)
{
    return gi::checked_line(j.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

Json json_of(Batch const& b)
{
    Json j{{"format", kPlanFormat},   {"name", b.name},         {"program", b.program},
           {"tasks", b.tasks.size()}, {"files", Json::array()}, {"merges", Json::array()}};
    for (InputFile const& f : b.files)
        j["files"].push_back({f.name, f.path.string(), f.sha256, f.bytes, f.changed_ns});
    for (Merge const& m : b.merges) j["merges"].push_back({m.group, m.file});
    return j;
}

Json json_of(Task const& t, std::size_t number)
{
    Json j{{"n", number},
           {"task", t.key},
           {"group", t.group},
           {"parameters", t.parameters},
           {"command", t.command},
           {"inputs", t.inputs},
           {"outputs", t.outputs},
           {"retries", t.retries},
           {"cores", t.resources.cores}};
    if (!t.standard_output.empty()) j["stdout"] = t.standard_output;
    if (t.resources.gpus > 0) j["gpus"] = t.resources.gpus;
    if (t.resources.memory_bytes > 0) j["memory_bytes"] = t.resources.memory_bytes;
    if (t.limit_s > 0) j["limit_s"] = t.limit_s;
    return j;
}

gi::InputError damaged(std::string const& file, std::size_t line, std::string const& why)
{
    return {gi::TextLocation{file, int(line), 0}, "this plan of a batch cannot be read", why,
            "call lightwell batch MANIFEST again: it makes the plan anew, finished tasks stay"};
}

Json parse(std::string_view line, std::string const& file, std::size_t number)
{
    if (!gi::checksum_holds(line)) throw damaged(file, number, "its checksum does not match");
    return Json::parse(line, nullptr, false);
}

/// @return the number of tasks
std::size_t read_head(std::string_view line, std::string const& file, Batch& b)
try {
    Json const j = parse(line, file, 1);
    if (j.at("format") != kPlanFormat) throw damaged(file, 1, "its format is not " + std::string(kPlanFormat));
    b.name = j.at("name");
    b.program = j.at("program");
    for (Json const& f : j.at("files")) {
        InputFile& input = b.files.emplace_back();
        input.name = f.at(0);
        input.path = f.at(1).get<std::string>();
        input.sha256 = f.at(2);
        input.bytes = f.at(3);
        input.changed_ns = f.at(4);
    }
    for (Json const& m : j.at("merges")) b.merges.push_back({m.at(0), m.at(1)});
    return j.at("tasks");
} catch (Json::exception const& e) {
    throw damaged(file, 1, e.what());
}

/// @param number of the task, from 0
Task read_task(std::string_view line, std::string const& file, std::size_t number)
try {
    Json const j = parse(line, file, number + 2);
    if (j.at("n") != number) throw damaged(file, number + 2, "it is the line of another task");
    Task t;
    t.key = j.at("task");
    t.group = j.at("group");
    t.parameters = j.at("parameters").get<std::vector<Parameter>>();
    t.command = j.at("command").get<std::vector<std::string>>();
    t.inputs = j.at("inputs").get<std::vector<int>>();
    t.outputs = j.at("outputs").get<std::vector<std::string>>();
    t.standard_output = j.value("stdout", "");
    t.retries = j.at("retries");
    t.limit_s = j.value("limit_s", 0.0);
    t.resources.cores = j.at("cores");
    t.resources.gpus = j.value("gpus", 0);
    t.resources.memory_bytes = j.value("memory_bytes", std::uint64_t(0));
    return t;
} catch (Json::exception const& e) {
    throw damaged(file, number + 2, e.what());
}

} // namespace

std::string text_of_batch(Batch const& batch)
{
    std::string text = line(json_of(batch));
    for (std::size_t i = 0; i < batch.tasks.size(); ++i) text += line(json_of(batch.tasks[i], i));
    return text;
}

std::string batch_id(Batch const& batch)
{
    std::string keys;
    for (Task const& t : batch.tasks) keys += t.key;
    return batch.name + "-" + gi::sha256(keys).substr(0, 8);
}

std::string index_of(std::string_view text)
{
    std::string index = fmt::format("{:016x}\n", 0);
    for (std::size_t end = 0; (end = text.find('\n', end)) + 1 < text.size() && end != text.npos; ++end)
        index += fmt::format("{:016x}\n", end + 1);
    return index;
}

Batch batch_of_text(std::string const& text, std::string const& file)
{
    Batch batch;
    std::string_view rest = text;
    std::size_t const tasks = read_head(gi::take_until(rest, '\n'), file, batch);
    batch.tasks.reserve(tasks);
    while (!rest.empty()) {
        if (rest.find('\n') == rest.npos) throw damaged(file, batch.tasks.size() + 2, "it is incomplete");
        batch.tasks.push_back(read_task(gi::take_until(rest, '\n'), file, batch.tasks.size()));
    }
    if (batch.tasks.size() != tasks) throw damaged(file, batch.tasks.size() + 1, "tasks are missing after it");
    return batch;
}

Batch batch_with_task(std::filesystem::path const& text_file, std::filesystem::path const& index_file,
                      std::size_t task)
{
    std::string const name = text_file.string();
    std::ifstream text(text_file, std::ios::binary), index(index_file, std::ios::binary);
    Batch batch;
    std::string line, place;
    std::getline(text, line);
    std::size_t const tasks = read_head(line, name, batch);
    if (task >= tasks)
        throw gi::InputError(fmt::format("there is no task {} in '{}'", task, name),
                             fmt::format("it has {} tasks, from 0", tasks), "choose another");
    index.seekg(std::streamoff(task + 1) * kIndexBytes);
    std::getline(index, place);
    text.seekg(std::streamoff(std::strtoull(place.c_str(), nullptr, 16)));
    std::getline(text, line);
    batch.tasks.push_back(read_task(line, name, task));
    return batch;
}

} // namespace viewer::batch
