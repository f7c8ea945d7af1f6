#pragma once
// Shows drawn surfaces: the picture of each eye is encoded, its outlines are smoothed, and both are composed at the view's size.
// A software driver takes a third of the time if it encodes first.

#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/outline_pass.h"

#include <map>

namespace viewer {

/// Belongs to the context that was current at its creation.
class SurfaceDisplay {
public:
    /// Drivers compile then, which takes long the first time.
    SurfaceDisplay();
    /// One eye's picture, encoded; smoothed if it is drawn. Valid until the next one of this number.
    /// @param settings  their stereo mode is not read
    TextureTarget const& encoded(int number, DisplayPass& pass, EyeView const& eye, DisplaySettings settings);
    /// Shows encoded pictures of both eyes, stretched where they are smaller. @param right  not read if stereo is off
    static void compose(DisplayPass& pass, DrawTarget const& to, TextureTarget const& left,
                        TextureTarget const& right, DisplaySettings settings);

private:
    struct Textures {
        TextureTarget encoded, smoothed;
    };
    std::map<int, Textures> textures_;
    OutlinePass outlines_;
};

} // namespace viewer
