#pragma once
// Recordings (.lwr) of everything that determines the pixels of every frame:
// enough to render a session again, bit by bit.
//
//   0  8 bytes   "\x89LWR\r\n\x1a\n"
//   8  u32       version of the format: 2 (1: without shown frames)
//   12 records   u32 length of the payload, u8 type, payload, u32 CRC-32 of length, type and payload
//
// All numbers are little-endian. Type 1, first and once: the header, as texts. Type 2: a frame. Type 3, last: the
// number of frames, present only if the recording was closed properly. Type 4: a shown frame. Frame numbers increase. A file is read up
// to the first incomplete record: a killed process leaves a recording without the last record.

#include "viewer/protocol/frame_command.h"
#include "viewer/protocol/recording/append_file.h"
#include "viewer/protocol/recording/frame_times.h"

#include <istream>
#include <memory>
#include <mutex>
#include <variant>

namespace viewer {

struct RecordingHeader {
    std::string program; ///< version and git hash
    std::string scene;   ///< name as given by the user
    std::string command_line;
    nlohmann::json settings; ///< before the first frame
    std::string created;     ///< UTC, "2026-05-04T12:30:00Z"

    bool operator==(RecordingHeader const&) const = default;
};

struct RecordedFrame {
    FrameCommand command;
    std::optional<std::uint64_t> pixel_hash; ///< see gi/core/xxhash.h
    std::optional<FrameTimes> times;

    bool operator==(RecordedFrame const&) const = default;
};

/// What one of several windows drew. They share no light.
struct WindowShown {
    double surfaces_scale = 0;
    std::vector<int> views; ///< in the order in which it drew them

    bool operator==(WindowShown const&) const = default;
};

/// A picture that people saw: of the newest frame then, perhaps drawn for newer poses.
struct ShownFrame {
    /// As the frame's, but with the poses, cameras and scene time that were shown, display_s of the swap, and for
    /// changes the edits of objects and lights that the frame does not have yet.
    FrameCommand moment;
    double surfaces_scale = 0;               ///< side of drawn surfaces over that of the views; 0 = none
    std::optional<std::uint64_t> pixel_hash; ///< shown_hash of viewer/app/shown_views.h
    std::vector<WindowShown> windows{};      ///< empty: one window drew all views, in their order

    bool operator==(ShownFrame const&) const = default;
};

/// May be used by several threads.
class Recorder {
public:
    /// An empty header.created is set to the current time. Throws InputError if the file exists, cannot be
    /// created, or the header is too long.
    Recorder(std::filesystem::path const& file, RecordingHeader header, gi::Report& report);
    ~Recorder();

    /// Does not wait for the disk. Throws InputError if check_command rejects the frame command, or its frame
    /// number is not above the previous one.
    void append(RecordedFrame const& frame);
    /// After the frame that it shows. Throws InputError if check_command rejects the moment.
    void append(ShownFrame const& shown);
    /// Why recording has stopped (e.g. a full disk); empty if it has not.
    std::string failure() const { return file_.failure(); }
    /// Number of frames in the file so far.
    std::uint64_t written_frames() const;
    /// Marks the end, waits for the disk and closes. May be called repeatedly.
    void finish();

private:
    mutable std::mutex mutex_;
    AppendFile file_;
    std::uint64_t chunks_ = 1;                ///< handed over, the header first
    std::vector<std::uint64_t> chunks_until_; ///< each frame
    std::optional<std::uint64_t> last_frame_;
    bool finished_ = false;
};

/// finished: closed properly. cut: no end record, as after a kill. damaged: some bytes are not a valid record.
enum class RecordingState { finished, cut, damaged };

struct RecordingEnd {
    RecordingState state = RecordingState::cut;
    std::string why; ///< reason if cut or damaged
    std::uint64_t frames = 0;
    std::optional<std::uint64_t> last_frame; ///< last frame read
    std::uint64_t unread_bytes = 0;          ///< after the last frame read
};

class RecordingReader {
public:
    /// Throws InputError if it is not a recording, has another version, or ends within its header.
    explicit RecordingReader(std::filesystem::path const& file);
    /// @param size bytes of `in` from its beginning
    RecordingReader(std::unique_ptr<std::istream> in, std::uint64_t size, std::string name);

    RecordingHeader const& header() const { return header_; }
    std::string const& name() const { return name_; }
    std::uint64_t bytes() const { return size_; }
    using Record = std::variant<RecordedFrame, ShownFrame>;
    /// The next frame or shown frame; none at the end, which end() then describes.
    /// A damaged record ends the recording; it is not an error.
    std::optional<Record> next_record();
    /// The next frame, without those that were shown.
    std::optional<RecordedFrame> next();
    /// Valid after next() has returned none.
    RecordingEnd const& end() const { return end_; }
    /// Restarts at the first frame.
    void rewind();

private:
    struct Raw {
        std::uint8_t type = 0;
        Bytes payload;
    };
    Raw read_record();
    void read_header();
    void end_at(RecordingState state, std::uint64_t unread, std::string const& why);

    std::unique_ptr<std::istream> in_;
    std::uint64_t size_ = 0, at_ = 0, first_frame_at_ = 0;
    std::string name_;
    RecordingHeader header_;
    RecordingEnd end_;
    bool ended_ = false;
};

/// One line about the unread part of a recording that was not closed properly; empty if it was.
std::string describe_loss(RecordingEnd const& end);

} // namespace viewer
