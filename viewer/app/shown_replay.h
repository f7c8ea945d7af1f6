#pragma once
// Draws again what people saw: every picture that a recording says was shown, from the frames rendered again.

#include "viewer/app/replayed_eyes.h"
#include "viewer/app/shown_views.h"
#include "viewer/app/surface_display.h"
#include "viewer/devices/gl/context.h"

#include <deque>

namespace viewer {

/// Has an OpenGL context of its own, which must stay current.
class ShownReplay {
public:
    ShownReplay(DriveBodies drive, gi::Report& report);
    /// @param views  of the command as it was recorded
    void keep(FrameCommand const& command, SessionFrame result, RecordedViews const& views);

    /// The views of the frame that was shown, and what was drawn of them; valid until the next call.
    struct Drawn {
        RecordedViews views;
        std::vector<EyeView> eyes; ///< by view; without a texture: not shown
    };
    /// Throws InputError if the frame that it shows is not in the recording, or its surfaces cannot be drawn.
    Drawn const& draw(ShownFrame const& shown);
    /// shown_hash() of what draw() drew.
    std::uint64_t hash() const;

    /// What the window showed of these eyes. @param settings  their stereo mode is that of the arrangement
    std::vector<unsigned char> bytes(EyeView const& left, EyeView const& right, Arrangement const& a,
                                     DisplaySettings settings);
    /// The linear picture.
    static gi::Picture linear(ShownPicture const& shown);

private:
    struct Kept {
        std::shared_ptr<LiveFrame const> frame;
        RecordedViews views;
    };
    GlContext gl_;
    DriveBodies drive_;
    std::deque<ShownViews> windows_; ///< as many as there were
    std::deque<Kept> waiting_;       ///< newer than the one that was taken
    Kept taken_;
    Drawn drawn_;
    DisplayPass pass_;
    std::optional<SurfaceDisplay> surface_display_;
    std::optional<TextureTarget> target_;
};

} // namespace viewer
