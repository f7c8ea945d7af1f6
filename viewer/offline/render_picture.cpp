#include "viewer/offline/render_picture.h"

#include "gi/core/error.h"
#include "viewer/offline/finish_picture.h"
#include "viewer/offline/state_saving.h"

namespace viewer {
namespace {

gi::PictureRows rows_of(gi::RenderResult const& result)
{
    return result.rows ? result.rows : gi::rows_of(result.picture);
}

/// The end of a complete render. Throws Interrupted; the result is as before then.
void finish(StillPicture const& picture, gi::StopRequest const& stop, StillEnd& end, gi::Report& report)
{
    gi::PictureRows rows = rows_of(end.result);
    gi::Picture filtered;
    if (picture.filter.denoiser != gi::Denoiser::none) {
        filtered = rows.whole(&stop);
        end.note = denoise(filtered, picture.filter, report);
        rows = gi::rows_of(filtered);
    }
    picture.write(rows, PictureParts::complete, end.result);
}

/// Saves what an interrupted render has, quickly: its state, and the picture, not filtered; where the state has
/// all of it, only its color.
void save_interrupted(StillPicture const& picture, StateSaving& state, gi::RenderResult& result,
                      gi::Report& report)
{
    if (state.has_state()) picture.write(result.color_rows, PictureParts::color_so_far, result);
    bool const is_saved = state.join(report);
    if (!is_saved) picture.write(rows_of(result), PictureParts::all_so_far, result);
    result.resumable |= is_saved;
}

} // namespace

bool check_state(gi::RenderSettings const& s, std::string const& advice)
{
    bool const is_there = !s.checkpoint.empty() && std::filesystem::exists(s.checkpoint);
    if (is_there && !s.resume)
        throw gi::InputError("'" + s.checkpoint.string() + "' holds an unfinished render",
                             "a new one would replace it", advice + " to continue, or delete it");
    return is_there || !s.resume;
}

StillEnd render_picture(StillPicture picture, gi::StopRequest const& stop, gi::Report& report)
{
    gi::RenderSettings& settings = picture.settings;
    settings.by_rows = true;
    picture.filter.stop = &stop;
    StillEnd end;
    gi::RenderResult& result = end.result;
    result = picture.trace(settings, stop, report);
    if (!picture.write) return end;
    std::optional<StateSaving> saving;
    bool is_left = result.end == gi::RenderEnd::interrupted;
    if (!is_left && settings.resume && result.end != gi::RenderEnd::paths)
        saving.emplace(result); // before the denoiser, which may take long, or fail
    try {
        if (!is_left) finish(picture, stop, end, report);
    } catch (gi::Interrupted const&) {
        is_left = true;
        result.end = gi::RenderEnd::interrupted;
        result.resumable = !saving && std::filesystem::exists(settings.checkpoint); // an earlier one
    } catch (std::exception const&) {                                               // for example a full disk
        end.failure = std::current_exception();
        if (!saving) saving.emplace(result);
        result.resumable = saving->join(report);
        return end;
    }
    if (is_left && picture.interrupted)
        picture.interrupted(saving || result.save_state ? PictureParts::color_so_far : PictureParts::all_so_far);
    if (is_left && !saving) saving.emplace(result, gi::DiskWait::no);
    if (is_left)
        save_interrupted(picture, *saving, result, report);
    else if (saving)
        result.resumable |= saving->join(report);
    if (!settings.checkpoint.empty() && !result.resumable) std::filesystem::remove(settings.checkpoint);
    result.picture = {};
    result.rows = result.color_rows = {};
    return end;
}

} // namespace viewer
