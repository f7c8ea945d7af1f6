#include "viewer/app/still_fade.h"

#include <algorithm>
#include <utility>

namespace viewer {

void StillFade::need(std::optional<TextureTarget>& target)
{
    if (!target) target.emplace(TextureTarget::Format::bytes, size_px_);
}

void StillFade::forget()
{
    surfaces_ = nullptr;
    shown_.reset();
    share_ = 1;
}

void StillFade::show_surfaces(TextureTarget const& drawn, gi::Camera const& camera,
                              gi::ToneMapSettings const& tone)
{
    surfaces_ = &drawn;
    shown_ = camera;
    tone_ = tone;
    share_ = 1;
}

TextureTarget const& StillFade::draw(DisplayPass& pass, FadePass const& fade, glm::ivec2 size_px,
                                     EyeView const& view, gi::Camera const& camera, StillPicture picture,
                                     DisplaySettings const& settings)
{
    if (size_px_ != size_px) {
        before_.reset(), after_.reset(), mixed_.reset();
        if (surfaces_ == nullptr) forget();
        size_px_ = size_px;
    }
    bool const same_view = shown_ == camera && settings.tone == tone_,
               is_new = surfaces_ != nullptr || picture.frame != frame_,
               begins = same_view && is_new && (surfaces_ != nullptr || picture.still_frames > 1),
               goes_on = same_view && !is_new && fades(),
               is_again = picture.moment != 0 && picture.moment == moment_;
    if (begins) {
        if (surfaces_ != nullptr) {
            need(before_);
            stretch(surfaces_->target(), before_->target());
        } else if (fades()) {
            fade.draw(mixed_->target(), before_->shown(), after_->shown(), share_);
            std::swap(before_, mixed_);
        } else {
            std::swap(before_, after_);
        }
        share_ = 0;
    }
    if (!begins && !goes_on) share_ = 1;
    need(after_);
    if (!goes_on) pass.draw(after_->target(), view, view, settings);
    if (fades() && !(goes_on && is_again))
        share_ = std::min(share_ + float(std::max(picture.still_frames, 1)) / kSteps, 1.0f);
    surfaces_ = nullptr;
    shown_ = camera;
    frame_ = picture.frame;
    moment_ = picture.moment;
    tone_ = settings.tone;
    if (!fades()) {
        before_.reset(), mixed_.reset();
        return *after_;
    }
    need(mixed_);
    fade.draw(mixed_->target(), before_->shown(), after_->shown(), share_);
    return *mixed_;
}

} // namespace viewer
