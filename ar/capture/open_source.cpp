#include "ar/capture/open_source.h"

#include "ar/capture/counter_source.h"
#include "ar/capture/libcamera_source.h"
#include "ar/capture/picture_source.h"
#include "ar/capture/session_reader.h"
#include "ar/capture/video_source.h"
#include "gi/core/error.h"
#include "gi/core/text.h"

#include <fmt/format.h>

namespace ar {
namespace {

/// The text after the prefix; none if the text does not begin with it.
std::optional<std::string> after(std::string const& name, std::string const& prefix)
{
    return name.starts_with(prefix) ? std::optional(name.substr(prefix.size())) : std::nullopt;
}

int device_number(std::string const& text)
{
    auto const number = gi::parse_number<int>(text);
    if (!number || *number < 0)
        throw gi::InputError("device:" + text, "'" + text + "' is no number of a camera",
                             "write device:0 for /dev/video0");
    return *number;
}

void refuse_first(std::string const& name, OpenOptions const& o)
{
    if (o.first_number.value_or(0) != 0)
        throw gi::InputError(fmt::format("frames.first: {} with '{}'", *o.first_number, name),
                             "it is the number of the picture at time 0, and only pictures have one",
                             "leave it out");
}

std::unique_ptr<FrameSource> open_files(std::filesystem::path const& path, OpenOptions const& o)
{
    std::error_code error;
    bool const is_folder = std::filesystem::is_directory(path, error);
    bool const is_recorded = is_folder && std::filesystem::exists(path / kSessionFile, error);
    bool const is_pictures =
        !is_recorded && (is_folder || (path.filename().string().find('%') != std::string::npos &&
                                       !std::filesystem::exists(path, error)));
    if (!is_pictures) refuse_first(path.string(), o);
    if (is_recorded) return std::make_unique<SessionSource>(path, o.pace);
    if (is_pictures)
        return std::make_unique<PictureSource>(path, PictureOptions{o.frames_per_s, o.pace, o.first_number});
    return open_video(path, o.pace);
}

} // namespace

std::unique_ptr<FrameSource> open_source(std::string const& name, OpenOptions const& o)
{
    Controls controls = o.controls;
    if (!controls.frame_duration_s && o.frames_per_s > 0) controls.frame_duration_s = 1 / o.frames_per_s;
    LiveOptions const live{.size_px = o.size_px,
                           .frames_per_s = o.frames_per_s,
                           .format = o.format,
                           .delivery = o.delivery,
                           .controls = o.controls};
    for (char const* device : {"camera", "camera:", "device:", "gstreamer:", "counter"})
        if (name == device || (std::string_view(device).ends_with(':') && name.starts_with(device)))
            refuse_first(name, o);
    if (name == "camera" || name.starts_with("camera:"))
        return open_libcamera({.id = after(name, "camera:").value_or(""),
                               .size_px = o.size_px,
                               .format = o.format,
                               .delivery = o.delivery,
                               .controls = controls});
    if (auto const number = after(name, "device:")) return open_device(device_number(*number), live);
    if (auto const pipeline = after(name, "gstreamer:")) return open_pipeline(*pipeline, live);
    if (name == "counter")
        return std::make_unique<CounterSource>(CounterOptions{.size_px = o.size_px,
                                                              .frames_per_s = o.frames_per_s,
                                                              .format = o.format.value_or(PixelFormat::rgb8),
                                                              .pace = o.pace});
    return open_files(name, o);
}

} // namespace ar
