#pragma once
// Where frames come from: cameras, videos, pictures, recorded sessions. A source is used by one thread at a time;
// frames may be handed to others, and may outlive their source.

#include "ar/camera/frame.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace ar {

/// What a live source does with frames that came while nobody asked.
enum class Delivery {
    every, ///< oldest first; the camera waits (and loses frames) where too many lie here
    newest ///< the older ones are given up, and counted as dropped
};

/// How files are played.
enum class Pace {
    own,    ///< a frame comes when it is due; the first one at once
    fastest ///< a frame comes when it is asked for
};

struct SourceState {
    enum class Kind {
        running,
        ended, ///< all that there was has been delivered
        lost   ///< it broke off: unplugged, a stream that stopped, a file that cannot be read on
    };
    Kind kind = Kind::running;
    std::string reason = {}; ///< empty while running
};

struct SourceDescription {
    std::string name = {}; ///< as a person knows it: model, file, pipeline
    std::string id = {};   ///< that opens the same source again; may be the name
    glm::ivec2 size_px{0};
    PixelFormat format = PixelFormat::rgb8;
    double frames_per_s = 0;                ///< nominal; 0 = not known
    bool is_live = false;                   ///< frames come whether they are asked for or not
    std::vector<std::string> controls = {}; ///< of `Controls`, what can be set: "exposure_time", "gain",
                                            ///< "white_balance", "automatic", "frame_duration"
};

struct SourceCounts {
    std::uint64_t delivered = 0;
    std::uint64_t dropped = 0; ///< gaps of the sequence: lost before they came here, or given up for newer ones
    std::uint64_t refused = 0; ///< came, but truncated, of a wrong size or not to be decoded
    std::string last_refusal = {}; ///< names the frame and says why

    friend bool operator==(SourceCounts const&, SourceCounts const&) = default;
};

/// What is not set stays as it is.
struct Controls {
    std::optional<bool> automatic_exposure = {}; ///< time and gain
    std::optional<double> exposure_time_s = {};  ///< switches the automatic off
    std::optional<double> gain = {};             ///< 1 = none
    std::optional<bool> automatic_white_balance = {};
    std::optional<double> red_gain = {};  ///< against green, with blue_gain; switches the automatic off
    std::optional<double> blue_gain = {}; ///< against green
    std::optional<double> frame_duration_s = {};

    friend bool operator==(Controls const&, Controls const&) = default;
};

/// @throws gi::InputError what is not finite, not positive, automatic and set at once, or one of the two colours
/// alone
void check(Controls const& controls);

class FrameSource {
public:
    virtual ~FrameSource() = default;

    /// The next frame; nothing if none came within `wait` or none will come: `state` tells them apart. What has to
    /// be refused on the way is counted, and the next one is waited for.
    virtual std::optional<Frame> next(std::chrono::milliseconds wait) = 0;
    virtual SourceState state() const = 0;
    virtual SourceDescription description() const = 0;
    virtual SourceCounts counts() const = 0;
    /// From one of the next frames on; a frame's `exposure` says what it was taken with.
    /// @return what the device cannot do, a sentence each
    /// @throws gi::InputError see check(Controls)
    virtual std::vector<std::string> set(Controls const& controls) = 0;
};

/// One line: "290 frames, 3 dropped, 1 refused (picture 0017.png: ...)".
std::string describe(SourceCounts const& counts);

/// The names of what is set in `controls`, each as the sentence "NAME cannot be set: WHY"; for sources that have
/// no such control.
std::vector<std::string> cannot_set(Controls const& controls, std::string const& why);

} // namespace ar
