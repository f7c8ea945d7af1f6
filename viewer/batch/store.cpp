#include "viewer/batch/store.h"

#include "gi/core/checked_line.h"
#include "gi/core/durable_file.h"
#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/host_name.h"
#include "viewer/batch/batch_file.h"
#include "viewer/batch/file_hash.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char const* kFormat = "batch-store/1\n";

std::string line_of(Result const& r)
{
    Json j{{"task", r.task},         {"outputs", Json::array()},
           {"seconds", r.seconds},   {"memory_bytes", r.memory_bytes},
           {"attempts", r.attempts}, {"host", r.host}};
    for (Output const& o : r.outputs) j["outputs"].push_back({o.name, o.sha256, o.bytes});
    if (!r.messages.empty()) j["messages"] = r.messages;
    return gi::checked_line(j.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::optional<Result> result_of(std::string text)
{
    if (!text.ends_with('\n')) return std::nullopt;
    text.pop_back();
    if (!gi::checksum_holds(text)) return std::nullopt;
    try {
        Json const j = Json::parse(text);
        Result r;
        r.task = j.at("task");
        for (Json const& o : j.at("outputs")) r.outputs.push_back({o.at(0), o.at(1), o.at(2)});
        r.seconds = j.at("seconds");
        r.memory_bytes = j.at("memory_bytes");
        r.attempts = j.at("attempts");
        r.host = j.at("host");
        r.messages = j.value("messages", "");
        return r;
    } catch (Json::exception const&) {
        return std::nullopt;
    }
}

std::optional<Result> read_result(fs::path const& file, std::string const& key)
{
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    auto found = result_of({std::istreambuf_iterator<char>(in), {}});
    return found && found->task == key ? found : std::nullopt;
}

bool has_size(fs::path const& file, std::uint64_t bytes)
{
    std::error_code failed;
    return fs::file_size(file, failed) == bytes && !failed;
}

bool is_whole(fs::path const& file, Output const& output)
try {
    return has_size(file, output.bytes) && file_sha256(file) == output.sha256;
} catch (gi::InputError const&) { // it cannot be read
    return false;
}

gi::InputError cannot_keep(fs::path const& file, std::string const& why)
{
    return {"cannot keep '" + file.string() + "'", why, "free some space, or check the permissions of the store"};
}

/// Names of the outputs that were made, those of folders file by file.
std::vector<std::string> files_of(std::vector<Output> const& outputs, fs::path const& made)
{
    std::vector<std::string> names;
    for (Output const& o : outputs) {
        if (!o.name.ends_with('/')) {
            names.push_back(o.name);
            continue;
        }
        for (auto const& entry : fs::recursive_directory_iterator(made / o.name))
            if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(made).string());
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

fs::path index_file(fs::path const& plan)
{
    return plan.parent_path() / ("." + plan.filename().string() + ".index");
}

void write(fs::path const& file, std::string const& text)
{
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw cannot_keep(file, std::strerror(errno));
}

/// Hands everything that was written to this file system to its disk.
void sync_all(fs::path const& folder)
{
    int const fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    int const error = fd < 0 || ::syncfs(fd) != 0 ? errno : 0;
    if (fd >= 0) ::close(fd);
    if (error != 0) throw cannot_keep(folder, std::strerror(error));
}

} // namespace

Store Store::open(fs::path const& folder)
{
    std::error_code none;
    if (!fs::exists(folder / "format", none))
        throw gi::InputError("'" + folder.string() + "' is no store of a batch", "it has no file 'format'",
                             "name the folder that `lightwell batch MANIFEST` printed");
    if (std::string const format = gi::read_text(folder / "format", 64); format != kFormat)
        throw gi::InputError("'" + folder.string() + "' is a store of another version",
                             "its format is '" + format.substr(0, format.find('\n')) + "'",
                             "use the version that made it, or another store");
    return Store(fs::canonical(folder));
}

Store Store::open_or_make(fs::path const& folder)
{
    std::error_code none;
    if (!fs::exists(folder / "format", none)) {
        if (fs::exists(folder, none) && !fs::is_empty(folder, none))
            for (auto const& entry : fs::directory_iterator(folder))
                if (entry.path().filename() != "batches" && entry.path().filename() != "objects" &&
                    entry.path().filename() != "results" && entry.path().filename() != "journal" &&
                    entry.path().filename() != "claims" && entry.path().filename() != "work" &&
                    entry.path().filename() != "format" && // another process has just made the store
                    !entry.path().filename().string().starts_with(".format"))
                    throw gi::InputError("'" + folder.string() + "' cannot be the store of a batch",
                                         "it holds other files, such as '" + entry.path().filename().string() +
                                             "'",
                                         "name a new or empty folder with --store");
        for (char const* const part : {"batches", "objects", "results", "journal", "claims", "work"})
            gi::make_folder(folder / part);
        gi::write_durably(folder / "format", kFormat);
    }
    return open(folder);
}

fs::path Store::object(std::string const& sha256) const
{
    return folder_ / "objects" / sha256.substr(0, 2) / sha256.substr(2);
}

fs::path Store::result_file(std::string const& key) const { return folder_ / "results" / key.substr(0, 2) / key; }

fs::path Store::prepared_file(std::string const& key) const { return work(key).string() + ".result"; }

std::optional<Result> Store::result(std::string const& key) const
{
    auto found = read_result(result_file(key), key);
    if (!found) return std::nullopt;
    for (Output const& o : found->outputs)
        if (!has_size(object(o.sha256), o.bytes)) return std::nullopt;
    return found;
}

void Store::prepare(Result& result) const
{
    fs::path const made = work(result.task);
    std::vector<Output> outputs;
    try {
        for (std::string const& name : files_of(result.outputs, made)) {
            Output output{name, file_sha256(made / name), fs::file_size(made / name)};
            fs::path const to = object(output.sha256);
            output.is_new = !has_size(to, output.bytes);
            if (output.is_new) {
                fs::create_directories(to.parent_path());
                fs::permissions(made / name,
                                fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
                fs::rename(made / name, to);
            }
            outputs.push_back(std::move(output));
        }
        result.outputs = std::move(outputs);
        result.host = gi::host_name();
        write(prepared_file(result.task), line_of(result));
    } catch (fs::filesystem_error const& e) {
        throw cannot_keep(e.path2().empty() ? e.path1() : e.path2(), e.code().message());
    }
}

void Store::publish(std::string const& key) const
{
    fs::path const to = result_file(key);
    try {
        fs::create_directories(to.parent_path());
        sync_all(folder_);
        fs::rename(prepared_file(key), to);
    } catch (fs::filesystem_error const& e) {
        throw cannot_keep(to, e.code().message());
    }
}

void Store::withdraw(Result const& prepared) const
{
    std::error_code none;
    fs::remove(prepared_file(prepared.task), none);
    for (Output const& o : prepared.outputs)
        if (o.is_new) fs::remove(object(o.sha256), none);
}

std::optional<Result> Store::recover(std::string const& key) const
{
    fs::path const prepared = prepared_file(key);
    std::error_code none;
    if (!fs::exists(prepared, none)) return std::nullopt;
    auto found = read_result(prepared, key);
    bool can_publish = found.has_value();
    if (found)
        for (Output const& o : found->outputs)
            if (!is_whole(object(o.sha256), o)) {
                can_publish = false;
                fs::remove(object(o.sha256), none);
            }
    if (can_publish) {
        publish(key);
        return found;
    }
    fs::remove(prepared, none);
    return std::nullopt;
}

void Store::forget(std::string const& key, std::string const& object_sha256) const
{
    std::error_code none;
    fs::remove(result_file(key), none);
    fs::remove(object(object_sha256), none);
}

std::string Store::keep(Batch const& batch) const
{
    std::string const text = text_of_batch(batch), id = batch_id(batch);
    fs::path const file = folder_ / "batches" / id;
    std::error_code failed;
    if (!fs::exists(file, failed) || gi::read_text(file) != text) {
        gi::write_durably(index_file(file), index_of(text));
        gi::write_durably(file, text);
    } else {
        fs::last_write_time(file, fs::file_time_type::clock::now(), failed); // the newest one is meant by default
    }
    return id;
}

std::vector<std::string> Store::batches() const
{
    std::vector<std::pair<fs::file_time_type, std::string>> found;
    std::error_code none;
    for (auto const& entry : fs::directory_iterator(folder_ / "batches", none))
        if (!entry.path().filename().string().starts_with('.'))
            found.emplace_back(entry.last_write_time(none), entry.path().filename().string());
    std::sort(found.rbegin(), found.rend());
    std::vector<std::string> ids;
    for (auto const& [time, id] : found) ids.push_back(id);
    return ids;
}

std::string Store::find_batch(std::string const& wanted) const
{
    auto const ids = batches();
    if (ids.empty())
        throw gi::InputError("the store '" + folder_.string() + "' has no batch", "nothing was started in it",
                             "lightwell batch MANIFEST starts one");
    for (std::string const& id : ids)
        if (wanted.empty() || id == wanted || id.substr(0, id.rfind('-')) == wanted) return id;
    throw gi::InputError("the store has no batch '" + wanted + "'", "that one was not started in it",
                         gi::suggest(wanted, ids));
}

Batch Store::batch(std::string const& id) const
{
    fs::path const file = folder_ / "batches" / id;
    return batch_of_text(gi::read_text(file), file.string());
}

Batch Store::batch_of_task(std::string const& id, std::size_t index) const
{
    fs::path const file = folder_ / "batches" / id;
    return batch_with_task(file, index_file(file), index);
}

} // namespace viewer::batch
