#pragma once
// A still picture that can be interrupted at any time and resumed: its paths are traced until their number, the time or
// the error is reached, or a stop is requested; then it is filtered and written. Its state, from which the paths go on,
// is a file (RenderSettings::checkpoint) that is deleted when the picture is written.

#include "gi/filter/denoise.h"
#include "gi/render/render_settings.h"

#include <exception>

namespace viewer {

/// What is written of a picture.
enum class PictureParts : std::uint8_t {
    complete,     ///< all of it, filtered; a stop request may end this with Interrupted
    color_so_far, ///< of an interrupted picture; the state has the rest
    all_so_far    ///< of an interrupted picture without a state, not filtered
};

struct StillPicture {
    /// `checkpoint` (empty = no state is kept) and `resume` say what becomes of the state.
    gi::RenderSettings settings;
    gi::DenoiseSettings filter = {};
    /// Traces the paths by these settings until the stop request: Method::render or expose().
    std::function<gi::RenderResult(gi::RenderSettings const&, gi::StopRequest const&, gi::Report&)> trace = {};
    /// Writes the picture, in which rows are made as they are read. Of an interrupted picture: soon, without asking
    /// for a stop. Empty: another process has the picture, and this one ends after its paths.
    std::function<void(gi::PictureRows const&, PictureParts, gi::RenderResult const&)> write = {};
    /// Called before parts of an interrupted picture are written; may be empty.
    std::function<void(PictureParts)> interrupted = {};
};

struct StillEnd {
    gi::RenderResult result;    ///< without its picture; if `resumable`, the state is there
    std::exception_ptr failure; ///< why the complete picture could not be filtered or written
    std::string note;           ///< to the user; empty = none
};

/// Throws InputError if the file holds the state of an unfinished picture that is not to be resumed.
/// @param advice  how to resume, for the message   @return false if a state is to be resumed and there is none
bool check_state(gi::RenderSettings const& settings, std::string const& advice);

/// Throws what `trace` throws: Interrupted, if a stop is requested before there is anything to keep.
StillEnd render_picture(StillPicture picture, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
