#include "ar/capture/session_reader.h"

#include "gi/core/error.h"

#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace ar {
namespace {

namespace fs = std::filesystem;

SessionHeader read_header(fs::path const& folder)
{
    fs::path const file = folder / kSessionFile;
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw gi::InputError("'" + folder.string() + "' is no recorded session",
                             "there is no " + std::string(kSessionFile), "name a folder that was recorded");
    std::stringstream text;
    text << in.rdbuf();
    return parse_session_header(text.str(), file.string());
}

std::uint64_t size_of(fs::path const& file)
{
    std::error_code error;
    auto const size = fs::file_size(file, error);
    return error ? 0 : size;
}

} // namespace

SessionReader::SessionReader(fs::path const& folder)
    : SessionReader(read_header(folder), std::make_unique<std::ifstream>(folder / kIndexFile, std::ios::binary),
                    std::make_unique<std::ifstream>(folder / kFramesFile, std::ios::binary),
                    size_of(folder / kFramesFile), folder.string())
{
}

SessionReader::SessionReader(SessionHeader header, std::unique_ptr<std::istream> index,
                             std::unique_ptr<std::istream> frames, std::uint64_t frames_size, std::string name)
    : header_(std::move(header)),
      index_(std::move(index)),
      frames_(std::move(frames)),
      frames_size_(frames_size),
      name_(std::move(name))
{
}

std::optional<Frame> SessionReader::next()
{
    for (std::string text; std::getline(*index_, text);) {
        if (index_->eof()) { // no newline: writing was interrupted
            torn_ = text.size();
            return std::nullopt;
        }
        ++line_;
        std::string problem;
        auto const entry = parse_index_line(text, problem);
        if (entry && entry->controls) {
            controls_ = *entry->controls;
            continue;
        }
        ++frame_lines_;
        if (!entry)
            tally_.refuse(++last_, fmt::format("line {} of the index is {}", line_, problem));
        else if (auto frame = read(*entry))
            return frame;
    }
    return std::nullopt;
}

std::optional<Frame> SessionReader::read(IndexEntry const& e)
{
    last_ = e.frame.sequence;
    auto const refuse = [&](std::string const& why) {
        tally_.refuse(last_, fmt::format("frame {}: {}", last_, why));
        return std::nullopt;
    };
    if (e.at > frames_size_ || e.bytes > frames_size_ - e.at) return refuse("its bytes are not all there");
    std::vector<std::uint8_t> bytes(e.bytes);
    frames_->clear();
    frames_->seekg(std::streamoff(e.at));
    frames_->read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (!*frames_) return refuse("its bytes cannot be read");
    if (checksum(bytes) != e.sum) return refuse("its bytes were changed (checksum)");
    Frame f = e.frame;
    set_packed_planes(f, std::move(bytes));
    tally_.deliver(f.sequence);
    return f;
}

SourceState SessionReader::end() const
{
    using Kind = SourceState::Kind;
    if (!header_.finished)
        return {Kind::lost,
                fmt::format("the recording was cut off; {} bytes of its last line are left out", torn_)};
    if (header_.finished->frames != frame_lines_)
        return {Kind::lost, fmt::format("the index has {} of {} frames", frame_lines_, header_.finished->frames)};
    return {Kind::ended, "that was the last frame"};
}

SessionSource::SessionSource(fs::path const& folder, Pace pace)
    : reader_(folder), ready_(reader_.next()), player_(pace)
{
    if (ready_) return;
    auto const& counts = reader_.counts();
    throw gi::InputError("the session '" + folder.string() + "' has no frame",
                         counts.refused > 0
                             ? fmt::format("{} are damaged, the last: {}", counts.refused, counts.last_refusal)
                             : reader_.end().reason,
                         "copy the whole folder again; if it is so at its source, record once more");
}

std::optional<Frame> SessionSource::next(std::chrono::milliseconds wait)
{
    if (!ready_) return std::nullopt;
    double const until = until_s(wait), age_s = ready_->arrived_s - ready_->captured_s;
    auto const due_s = player_.wait_for(ready_->arrived_s, until);
    if (!due_s) return std::nullopt;
    Frame f = std::move(*ready_);
    ready_ = reader_.next();
    if (!player_.is_fastest()) {
        f.captured_s = *due_s - age_s;
        f.arrived_s = steady_now_s();
    }
    f.origin = TimestampOrigin::file;
    ++delivered_;
    return f;
}

SourceState SessionSource::state() const { return ready_ ? SourceState{} : reader_.end(); }

SourceDescription SessionSource::description() const
{
    SourceDescription d = reader_.header().camera;
    d.name += " (recorded)";
    d.id = reader_.name();
    d.controls.clear();
    d.is_live = false;
    return d;
}

SourceCounts SessionSource::counts() const
{
    SourceCounts c = reader_.counts();
    c.delivered = delivered_; // the reader is ahead
    return c;
}

std::vector<std::string> SessionSource::set(Controls const& controls)
{
    check(controls);
    return cannot_set(controls, "the frames were recorded");
}

} // namespace ar
