#include "gi/core/crc32.h"
#include "gi/core/error.h"
#include "viewer/protocol/json_text.h"
#include "viewer/protocol/recording/record_format.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>

namespace viewer {
namespace {

namespace fs = std::filesystem;

/// Thrown if the file ends within a record, or where one should begin.
struct Cut : BadBytes {
    using BadBytes::BadBytes;
};

gi::InputError no_recording(std::string const& name, std::string const& why, std::string const& suggestion)
{
    return gi::InputError("cannot read '" + name + "' as a recording", why, suggestion);
}

std::uint64_t size_of(fs::path const& file)
{
    std::error_code error;
    if (!fs::exists(file, error)) throw no_recording(file.string(), "there is no such file", "check the path");
    if (!fs::is_regular_file(file, error)) throw no_recording(file.string(), "it is no file", "name a .lwr file");
    std::uint64_t const size = fs::file_size(file, error);
    if (error) throw no_recording(file.string(), error.message(), "check its permissions");
    return size;
}

RecordedFrame frame_of(Bytes const& payload)
{
    ByteReader from(payload);
    RecordedFrame f;
    std::uint8_t const flags = from.byte();
    if (flags > 3) throw BadBytes("a frame has unknown content");
    if ((flags & 1) != 0) f.pixel_hash = from.u64();
    if ((flags & 2) != 0) f.times = get_frame_times(from);
    f.command = command_from_bytes(from.take(from.left()));
    if (f.times) {
        f.times->frame = f.command.frame;
        f.times->pose_s = f.command.pose_s;
        f.times->display_s = f.command.display_s;
    }
    return f;
}

double surfaces_scale_of(ByteReader& from)
{
    double const scale = from.number();
    if (!(scale >= 0 && scale <= 4)) throw BadBytes("surfaces of a shown frame have no size");
    return scale;
}

/// A number of things of at least so many bytes each.
std::uint32_t count_of(ByteReader& from, std::size_t least_bytes)
{
    std::uint32_t const n = from.u32();
    if (n > from.left() / least_bytes) throw BadBytes("a shown frame ends too early");
    return n;
}

ShownFrame shown_of(Bytes const& payload)
{
    ByteReader from(payload);
    ShownFrame s;
    std::uint8_t const flags = from.byte();
    if (flags > 3) throw BadBytes("a shown frame has unknown content");
    if ((flags & 1) != 0) s.pixel_hash = from.u64();
    s.surfaces_scale = surfaces_scale_of(from);
    if ((flags & 2) != 0) s.windows.resize(count_of(from, sizeof(double) + sizeof(std::uint32_t)));
    for (WindowShown& w : s.windows) {
        w.surfaces_scale = surfaces_scale_of(from);
        w.views.resize(count_of(from, sizeof(std::uint32_t)));
        for (int& view : w.views) view = int(from.u32());
    }
    s.moment = command_from_bytes(from.take(from.left()));
    for (WindowShown const& w : s.windows)
        for (int const view : w.views)
            if (view < 0 || std::size_t(view) >= s.moment.views.size())
                throw BadBytes("a window shows a view that its frame does not have");
    return s;
}

} // namespace

RecordingReader::RecordingReader(fs::path const& file)
    : RecordingReader(std::make_unique<std::ifstream>(file, std::ios::binary), size_of(file), file.string())
{
}

RecordingReader::RecordingReader(std::unique_ptr<std::istream> in, std::uint64_t size, std::string name)
    : in_(std::move(in)), size_(size), name_(std::move(name))
{
    if (!*in_) throw no_recording(name_, "it cannot be opened", "check its permissions");
    read_header();
    rewind();
}

RecordingReader::Raw RecordingReader::read_record()
{
    std::uint64_t const left = size_ - at_;
    if (left < kRecordHead + kRecordTail) throw Cut("it ends within a record");
    Bytes head(kRecordHead);
    in_->read(reinterpret_cast<char*>(head.data()), kRecordHead);
    ByteReader from(head);
    std::uint32_t const length = from.u32();
    if (length > kMostPayload) throw BadBytes(fmt::format("a record claims {} bytes", length));
    if (length > left - kRecordHead - kRecordTail) throw Cut("it ends within a record");
    Raw record{from.byte(), Bytes(length)};
    in_->read(reinterpret_cast<char*>(record.payload.data()), length);
    Bytes tail(kRecordTail);
    in_->read(reinterpret_cast<char*>(tail.data()), kRecordTail);
    if (!*in_) throw Cut("it cannot be read to its end");
    if (ByteReader(tail).u32() != gi::crc32(record.payload, gi::crc32(head)))
        throw BadBytes("the checksum of a record is wrong");
    at_ += kRecordHead + length + kRecordTail;
    return record;
}

void RecordingReader::read_header()
{
    Bytes start(std::min<std::uint64_t>(size_, kRecordingMagic.size() + 4));
    in_->read(reinterpret_cast<char*>(start.data()), std::streamsize(start.size()));
    if (!*in_ || start.size() < kRecordingMagic.size() ||
        !std::equal(kRecordingMagic.begin(), kRecordingMagic.end(), start.begin()))
        throw no_recording(name_, "it does not begin as one", "name a file that --record has made");
    try {
        ByteReader from(start);
        from.take(kRecordingMagic.size());
        std::uint32_t const version = from.u32();
        if (version < kOldestRecordingVersion || version > kRecordingVersion)
            throw no_recording(name_,
                               fmt::format("its format is {}, this version reads {} to {}", version,
                                           kOldestRecordingVersion, kRecordingVersion),
                               "use the version of the program that recorded it");
        at_ = start.size();
        Raw const record = read_record();
        if (record.type != kHeaderRecord) throw BadBytes("its first record is not a header");
        ByteReader texts(record.payload);
        header_.program = texts.text(kMostHeaderText);
        header_.scene = texts.text(kMostHeaderText);
        header_.command_line = texts.text(kMostHeaderText);
        header_.settings = parse_json(texts.text(kMostHeaderText));
        header_.created = texts.text(kMostHeaderText);
        if (texts.left() > 0) throw BadBytes("its header is longer than expected");
        first_frame_at_ = at_;
    } catch (BadBytes const& e) {
        throw no_recording(name_, std::string("its header is not whole: ") + e.what(),
                           "nothing can be rendered without it; record again");
    }
}

void RecordingReader::rewind()
{
    in_->clear();
    in_->seekg(std::streamoff(first_frame_at_));
    at_ = first_frame_at_;
    end_ = {};
    ended_ = false;
}

void RecordingReader::end_at(RecordingState state, std::uint64_t unread, std::string const& why)
{
    end_.state = state;
    end_.unread_bytes = unread;
    end_.why = why;
    ended_ = true;
}

std::optional<RecordedFrame> RecordingReader::next()
{
    while (auto record = next_record())
        if (auto* const frame = std::get_if<RecordedFrame>(&*record)) return std::move(*frame);
    return {};
}

std::optional<RecordingReader::Record> RecordingReader::next_record()
{
    if (ended_) return {};
    std::uint64_t const before = at_;
    try {
        if (at_ == size_) {
            end_at(RecordingState::cut, 0, "it was not closed properly");
            return {};
        }
        Raw const record = read_record();
        if (record.type == kEndRecord) {
            if (ByteReader(record.payload).u64() != end_.frames)
                throw BadBytes("its end record has a different number of frames");
            if (at_ != size_) {
                end_at(RecordingState::damaged, size_ - at_, "there are bytes after its end");
                return {};
            }
            end_at(RecordingState::finished, 0, "");
            return {};
        }
        if (record.type == kShownRecord) return shown_of(record.payload);
        if (record.type != kFrameRecord) throw BadBytes(fmt::format("a record is of type {}", record.type));
        RecordedFrame frame = frame_of(record.payload);
        if (end_.last_frame && frame.command.frame <= *end_.last_frame)
            throw BadBytes(fmt::format("frame {} follows frame {}", frame.command.frame, *end_.last_frame));
        end_.last_frame = frame.command.frame;
        ++end_.frames;
        return frame;
    } catch (Cut const& e) {
        end_at(RecordingState::cut, size_ - before, e.what());
    } catch (BadBytes const& e) {
        end_at(RecordingState::damaged, size_ - before, e.what());
    } catch (gi::InputError const& e) { // from the frame command
        end_at(RecordingState::damaged, size_ - before, e.what());
    }
    return {};
}

std::string describe_loss(RecordingEnd const& end)
{
    if (end.state == RecordingState::finished) return "";
    std::string const last =
        end.last_frame ? fmt::format("frame {} is the last", *end.last_frame) : "it has no frame";
    return fmt::format("the recording is {}: {}, {}, {} bytes after it are not read",
                       end.state == RecordingState::cut ? "cut" : "damaged", end.why, last, end.unread_bytes);
}

} // namespace viewer
