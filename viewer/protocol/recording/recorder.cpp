#include "gi/core/crc32.h"
#include "gi/core/error.h"
#include "viewer/protocol/json_text.h"
#include "viewer/protocol/recording/record_format.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>

namespace viewer {
namespace {

void put_record(ByteWriter& to, RecordType type, Bytes const& payload)
{
    ByteWriter head;
    head.put_u32(std::uint32_t(payload.size()));
    head.put_byte(type);
    to.put_raw(head.bytes());
    to.put_raw(payload);
    to.put_u32(gi::crc32(payload, gi::crc32(head.bytes())));
}

Bytes header_bytes(RecordingHeader const& h)
{
    ByteWriter payload;
    for (std::string const& text : {h.program, h.scene, h.command_line, json_line(h.settings), h.created}) {
        if (text.size() > kMostHeaderText)
            throw gi::InputError(
                "a recording's header is too long",
                fmt::format("it has a text of {} bytes, the limit is {}", text.size(), kMostHeaderText),
                "record without so many settings");
        payload.put_text(text);
    }
    ByteWriter file;
    file.put_raw(kRecordingMagic);
    file.put_u32(kRecordingVersion);
    put_record(file, kHeaderRecord, payload.bytes());
    return file.take();
}

} // namespace

Recorder::Recorder(std::filesystem::path const& file, RecordingHeader header, gi::Report& report)
    : file_(file, "records of the recording", report)
{
    if (header.created.empty())
        header.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    file_.append(header_bytes(header));
}

Recorder::~Recorder() { finish(); }

void Recorder::append(RecordedFrame const& f)
{
    std::lock_guard const lock(mutex_);
    if (last_frame_ && f.command.frame <= *last_frame_)
        throw gi::InputError(fmt::format("frame {} cannot be recorded", f.command.frame),
                             fmt::format("it comes after frame {}", *last_frame_), "count frames up");
    ByteWriter payload;
    payload.put_byte(std::uint8_t((f.pixel_hash ? 1 : 0) + (f.times ? 2 : 0)));
    if (f.pixel_hash) payload.put_u64(*f.pixel_hash);
    if (f.times) put(payload, *f.times);
    payload.put_raw(to_bytes(f.command));
    ByteWriter record;
    put_record(record, kFrameRecord, payload.bytes());
    file_.append(record.bytes());
    last_frame_ = f.command.frame;
    chunks_until_.push_back(++chunks_);
}

void Recorder::append(ShownFrame const& shown)
{
    std::lock_guard const lock(mutex_);
    if (finished_) return;
    ByteWriter payload;
    payload.put_byte(std::uint8_t((shown.pixel_hash ? 1 : 0) + (shown.windows.empty() ? 0 : 2)));
    if (shown.pixel_hash) payload.put_u64(*shown.pixel_hash);
    payload.put_number(shown.surfaces_scale);
    if (!shown.windows.empty()) payload.put_u32(std::uint32_t(shown.windows.size()));
    for (WindowShown const& w : shown.windows) {
        payload.put_number(w.surfaces_scale);
        payload.put_u32(std::uint32_t(w.views.size()));
        for (int const view : w.views) payload.put_u32(std::uint32_t(view));
    }
    payload.put_raw(to_bytes(shown.moment));
    ByteWriter record;
    put_record(record, kShownRecord, payload.bytes());
    file_.append(record.bytes());
    ++chunks_;
}

std::uint64_t Recorder::written_frames() const
{
    std::lock_guard const lock(mutex_);
    return std::uint64_t(std::ranges::upper_bound(chunks_until_, file_.written_chunks()) - chunks_until_.begin());
}

void Recorder::finish()
{
    std::lock_guard const lock(mutex_);
    if (finished_) return;
    finished_ = true;
    ByteWriter payload, record;
    payload.put_u64(chunks_until_.size());
    put_record(record, kEndRecord, payload.bytes());
    if (file_.failure().empty()) file_.append(record.bytes());
    file_.close();
}

} // namespace viewer
