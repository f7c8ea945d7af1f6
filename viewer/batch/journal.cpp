#include "viewer/batch/journal.h"

#include "gi/core/checked_line.h"
#include "gi/core/error.h"
#include "gi/core/host_name.h"
#include "gi/core/text.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<char const*, 4> kNames{"started", "finished", "failed", "interrupted"};

std::string line_of(Event const& e)
{
    Json j{{"at_s", e.at_s},
           {"event", kNames[std::size_t(e.kind)]},
           {"task", e.task},
           {"attempt", e.attempt},
           {"process", e.process}};
    if (e.kind != EventKind::started) j["seconds"] = e.seconds;
    if (!e.why.empty()) j["why"] = e.why;
    if (!e.messages.empty()) j["messages"] = e.messages;
    return gi::checked_line(j.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::optional<Event> event_of(std::string_view line, std::string const& host)
{
    if (!gi::checksum_holds(line)) return std::nullopt;
    Json const j = Json::parse(line, nullptr, false);
    if (!j.is_object()) return std::nullopt;
    try {
        Event e;
        auto const kind = std::find(kNames.begin(), kNames.end(), j.at("event").get<std::string>());
        if (kind == kNames.end()) return std::nullopt;
        e.kind = EventKind(kind - kNames.begin());
        e.task = j.at("task");
        e.attempt = j.at("attempt");
        e.at_s = j.at("at_s");
        e.process = j.at("process");
        e.seconds = j.value("seconds", 0.0);
        e.why = j.value("why", "");
        e.messages = j.value("messages", "");
        e.host = host;
        return e;
    } catch (Json::exception const&) {
        return std::nullopt;
    }
}

} // namespace

TaskJournal::TaskJournal(fs::path const& folder) : file_(folder / (gi::host_name() + ".jsonl"))
{
    fd_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (fd_ < 0)
        throw gi::InputError("cannot open the journal '" + file_.string() + "'", std::strerror(errno),
                             "make the store writable");
}

TaskJournal::~TaskJournal() { ::close(fd_); }

void TaskJournal::append(Event event)
{
    event.at_s = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    event.process = getpid();
    std::string line = line_of(event);
    ::flock(fd_, LOCK_EX);
    struct stat is {};
    char last = '\n';
    bool const has_lines = ::fstat(fd_, &is) == 0 && is.st_size > 0;
    if (has_lines && ::pread(fd_, &last, 1, is.st_size - 1) == 1 && last != '\n') line.insert(line.begin(), '\n');
    ssize_t const written = ::write(fd_, line.data(), line.size());
    int const error = written < 0 ? errno : ENOSPC;
    ::flock(fd_, LOCK_UN);
    if (written != ssize_t(line.size()))
        throw gi::InputError("cannot write the journal '" + file_.string() + "'", std::strerror(error),
                             "free some space; finished tasks are kept");
}

std::vector<Event> TaskJournalReader::read()
{
    std::vector<Event> events;
    std::error_code none;
    for (auto const& entry : fs::directory_iterator(folder_, none)) {
        if (entry.path().extension() != ".jsonl") continue;
        std::uintmax_t& from = read_[entry.path()];
        std::ifstream in(entry.path(), std::ios::binary);
        in.seekg(std::streamoff(from));
        std::string const text{std::istreambuf_iterator<char>(in), {}};
        std::string_view rest = text;
        for (std::size_t end = 0; (end = rest.find('\n')) != rest.npos; rest.remove_prefix(end + 1)) {
            std::string_view const line = rest.substr(0, end);
            if (auto event = event_of(line, entry.path().stem().string()))
                events.push_back(*std::move(event));
            else
                damaged_ += !line.empty();
        }
        from += text.size() - rest.size();
    }
    return events;
}

} // namespace viewer::batch
