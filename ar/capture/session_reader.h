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
    /// @throws gi::InputError if it is not a session
    explicit SessionReader(std::filesystem::path const& folder);
    /// @param frames_size length of `frames` in bytes
    SessionReader(SessionHeader header, std::unique_ptr<std::istream> index, std::unique_ptr<std::istream> frames,
                  std::uint64_t frames_size, std::string name);

    SessionHeader const& header() const { return header_; }
    std::string const& name() const { return name_; }
    /// Returns the next intact frame exactly as recorded; nothing at the end. Damaged or missing frames count as
    /// refused; frames lost while recording are gaps in the sequence and count as dropped.
    std::optional<Frame> next();
    SourceCounts const& counts() const { return tally_.counts(); }
    /// The controls in effect at the last returned frame.
    Controls const& controls() const { return controls_; }
    /// State after the last frame; lost: the recording was cut off, or parts of it are missing.
    SourceState end() const;

private:
    std::optional<Frame> read(IndexEntry const& entry);

    SessionHeader header_;
    std::unique_ptr<std::istream> index_, frames_;
    std::uint64_t frames_size_ = 0, line_ = 0, frame_lines_ = 0;
    std::uint64_t torn_ = 0; // bytes of an incomplete last line
    std::string name_;
    Controls controls_;
    std::uint64_t last_ = 0; // sequence
    Tally tally_;
};

/// Plays a session as a source. At its own pace, recorded times are shifted so that the first frame arrives at
/// the first call, and each frame has its recorded age (plus any delay of delivery). As fast as possible, times
/// are those recorded. Origin: file.
class SessionSource final : public FrameSource {
public:
    /// @throws gi::InputError if it is not a session, or has no frame
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
