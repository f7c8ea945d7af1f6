#include "viewer/batch/batch_file.h"

#include "gi/core/checked_line.h"
#include "gi/core/error.h"
#include "gi/core/sha256.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace viewer::batch {
namespace {

using Json = nlohmann::ordered_json;

constexpr char const* kPlanFormat = "batch/1";

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

Json json_of(Task const& t)
{
    Json j{{"task", t.key},        {"group", t.group},          {"parameters", t.parameters},
           {"command", t.command}, {"inputs", t.inputs},        {"outputs", t.outputs},
           {"retries", t.retries}, {"cores", t.resources.cores}};
    if (!t.standard_output.empty()) j["stdout"] = t.standard_output;
    if (t.resources.gpus > 0) j["gpus"] = t.resources.gpus;
    if (t.resources.memory_bytes > 0) j["memory_bytes"] = t.resources.memory_bytes;
    if (t.limit_s > 0) j["limit_s"] = t.limit_s;
    return j;
}

void read_head(Json const& j, Batch& b)
{
    b.name = j.at("name");
    b.program = j.at("program");
    for (Json const& f : j.at("files")) {
        InputFile& file = b.files.emplace_back();
        file.name = f.at(0);
        file.path = f.at(1).get<std::string>();
        file.sha256 = f.at(2);
        file.bytes = f.at(3);
        file.changed_ns = f.at(4);
    }
    for (Json const& m : j.at("merges")) b.merges.push_back({m.at(0), m.at(1)});
}

Task task_of(Json const& j)
{
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
}

} // namespace

std::string text_of_batch(Batch const& batch)
{
    std::string text = line(json_of(batch));
    for (Task const& t : batch.tasks) text += line(json_of(t));
    return text;
}

std::string batch_id(Batch const& batch)
{
    std::string keys;
    for (Task const& t : batch.tasks) keys += t.key;
    return batch.name + "-" + gi::sha256(keys).substr(0, 8);
}

Batch batch_of_text(std::string const& text, std::string const& file, std::optional<std::size_t> only)
{
    Batch batch;
    std::size_t expected = 0, number = 0;
    std::string_view rest = text;
    auto const damaged = [&](std::string const& why) {
        return gi::InputError(gi::TextLocation{file, int(number) + 1, 0}, "this plan of a batch cannot be read",
                              why,
                              "call lightwell batch MANIFEST again: it makes the plan anew, finished tasks stay");
    };
    for (; !rest.empty(); ++number) {
        std::size_t const end = rest.find('\n');
        if (end == rest.npos) throw damaged("its last line is incomplete");
        std::string_view const line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (number > 0 && only && number != *only + 1) continue;
        if (!gi::checksum_holds(line)) throw damaged("a checksum does not match");
        try {
            Json const j = Json::parse(line);
            if (number > 0) {
                batch.tasks.push_back(task_of(j));
                continue;
            }
            if (j.at("format") != kPlanFormat) throw damaged("its format is not " + std::string(kPlanFormat));
            read_head(j, batch);
            expected = j.at("tasks");
        } catch (Json::exception const& e) {
            throw damaged(e.what());
        }
    }
    if (number == 0) throw damaged("it is empty");
    if (number != expected + 1) throw damaged("tasks are missing");
    if (only && batch.tasks.empty())
        throw gi::InputError(fmt::format("there is no task {} in '{}'", *only, file),
                             fmt::format("it has {} tasks, from 0", expected), "choose another");
    return batch;
}

} // namespace viewer::batch
