#pragma once
// Sources of frames: cameras, videos, pictures, recorded sessions. A source is used by one thread at a time;
// frames may be passed to other threads, and may outlive their source.

#include "ar/camera/frame.h"
#include "gi/core/report.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace ar {

/// What a live source does with frames that arrived between requests.
enum class Delivery {
    every, ///< delivers the oldest first; the camera stalls (and loses frames) while too many are queued
    newest ///< discards the older ones and counts them as dropped
};

/// How files are played.
enum class Pace {
    own,    ///< each frame at its own time; the first at once
    fastest ///< each frame when it is requested
};

struct SourceState {
    enum class Kind {
        running,
        ended, ///< all frames were delivered
        lost   ///< it failed: unplugged camera, stopped stream, unreadable rest of a file
    };
    Kind kind = Kind::running;
    std::string reason = {}; ///< empty while running
};

struct SourceDescription {
    std::string name = {}; ///< for people: model, file, pipeline
    std::string id = {};   ///< opens the same source again; may equal the name
    glm::ivec2 size_px{0};
    PixelFormat format = PixelFormat::rgb8;
    double frames_per_s = 0;                ///< nominal; 0 = not known
    bool is_live = false;                   ///< frames arrive whether they are requested or not
    std::vector<std::string> controls = {}; ///< settable parts of `Controls`: "exposure_time", "gain",
                                            ///< "white_balance", "automatic", "frame_duration"
    std::optional<std::uint64_t> first = {}; ///< sequence number of the time 0; nothing: that of the first frame
};

struct SourceCounts {
    std::uint64_t delivered = 0;
    std::uint64_t dropped = 0;     ///< gaps in the sequence: lost before arrival, or discarded for newer frames
    std::uint64_t refused = 0;     ///< arrived, but truncated, of a wrong size or undecodable
    std::string last_refusal = {}; ///< the frame and the reason
    std::uint64_t changed = 0;     ///< delivered, but of its file something was cut, chosen or converted
    std::string last_change = {};  ///< the frame, and what
    std::string missing = {};      ///< of numbered pictures: the numbers that are not there, "3, 5 to 7"
    std::string unnumbered = {};   ///< of a folder of pictures: why the digits in their names are no frame numbers

    friend bool operator==(SourceCounts const&, SourceCounts const&) = default;
};

/// Camera settings; empty values stay unchanged.
struct Controls {
    std::optional<bool> automatic_exposure = {}; ///< time and gain
    std::optional<double> exposure_time_s = {};  ///< switches automatic exposure off
    std::optional<double> gain = {};             ///< 1 = none
    std::optional<bool> automatic_white_balance = {};
    std::optional<double> red_gain = {};  ///< relative to green, with blue_gain; switches automatic balance off
    std::optional<double> blue_gain = {}; ///< relative to green
    std::optional<double> frame_duration_s = {};

    friend bool operator==(Controls const&, Controls const&) = default;
};

/// @throws gi::InputError values that are not finite or not positive, both automatic
/// and set, or only one colour gain
void check(Controls const& controls);

class FrameSource {
public:
    virtual ~FrameSource() = default;

    /// Returns the next frame; nothing if none arrived within `wait` or none will (`state` distinguishes the two).
    /// Refused frames are counted and skipped.
    virtual std::optional<Frame> next(std::chrono::milliseconds wait) = 0;
    virtual SourceState state() const = 0;
    virtual SourceDescription description() const = 0;
    virtual SourceCounts counts() const = 0;
    /// Takes effect a few frames later; each frame's `exposure` has the settings it was taken with.
    /// @return a sentence for each setting that the device does not support
    /// @throws gi::InputError see check(Controls)
    virtual std::vector<std::string> set(Controls const& controls) = 0;
};

/// One line: "290 frames, 3 dropped (not there: 7, 12 to 13), 1 refused (picture 0017.png: ...)".
std::string describe(SourceCounts const& counts);

/// Returns the sentence "NAME cannot be set: WHY" for each value set in `controls`; for sources without controls.
std::vector<std::string> cannot_set(Controls const& controls, std::string const& why);

/// Counts refused and changed frames, numbers of pictures that are missing, and names that are not numbers of frames.
void report_counts(SourceCounts const& counts, gi::Report& report);

/// report_counts. @throws gi::InputError if the source was lost
void report_losses(SourceCounts const& counts, SourceState const& state, gi::Report& report);

} // namespace ar
