#pragma once
// Reads recorded sessions (session_format.h) and plays them.

#include "ar/capture/player.h"
#include "ar/capture/session_format.h"
#include "ar/capture/tally.h"

#include <istream>
#include <memory>

namespace ar {

class SessionReader {
public:
    /// @throws gi::InputError it is no session
    explicit SessionReader(std::filesystem::path const& folder);
    /// @param frames_size bytes of `frames` from its beginning
    SessionReader(SessionHeader header, std::unique_ptr<std::istream> index, std::unique_ptr<std::istream> frames,
                  std::uint64_t frames_size, std::string name);

    SessionHeader const& header() const { return header_; }
    std::string const& name() const { return name_; }
    /// The next frame that is whole, exactly as it was recorded; nothing at the end. What is damaged or not there
    /// is refused and counted; frames that did not fit while recording are gaps of the sequence: dropped.
    std::optional<Frame> next();
    SourceCounts const& counts() const { return tally_.counts(); }
    /// What was set last before the frame that came last.
    Controls const& controls() const { return controls_; }
    /// After the last frame. lost: the recording was cut off, or something of it is not there any more.
    SourceState end() const;

private:
    std::optional<Frame> read(IndexEntry const& entry);

    SessionHeader header_;
    std::unique_ptr<std::istream> index_, frames_;
    std::uint64_t frames_size_ = 0, line_ = 0, frame_lines_ = 0;
    std::uint64_t torn_ = 0; // bytes of a last line that is not whole
    std::string name_;
    Controls controls_;
    std::uint64_t last_ = 0; // sequence
    Tally tally_;
};

/// At its own pace frames come as they came then: the recorded times are moved so that the first frame arrives at
/// the first call, and each has its age of then (plus what it comes late). As fast as possible: recorded times as
/// they are. Origin: file.
class SessionSource final : public FrameSource {
public:
    /// @throws gi::InputError it is no session, or has no frame
    explicit SessionSource(std::filesystem::path const& folder, Pace pace = Pace::own);

    std::optional<Frame> next(std::chrono::milliseconds wait) override;
    SourceState state() const override;
    SourceDescription description() const override;
    SourceCounts counts() const override;
    std::vector<std::string> set(Controls const& controls) override;
    SessionHeader const& header() const { return reader_.header(); }

private:
    SessionReader reader_;
    std::optional<Frame> ready_; ///< read, not yet due
    std::uint64_t delivered_ = 0;
    Player player_;
};

} // namespace ar
