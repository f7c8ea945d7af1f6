#include "viewer/app/shown_replay.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <numeric>

namespace viewer {

ShownReplay::ShownReplay(DriveBodies drive, gi::Report& report)
    : gl_(GlContext::surfaceless(report)), drive_(std::move(drive))
{
}

void ShownReplay::keep(FrameCommand const& command, SessionFrame result, RecordedViews const& views)
{
    auto const frame = std::make_shared<LiveFrame>();
    frame->command = command;
    frame->result = std::move(result);
    constexpr std::size_t kMost = 64; // far more than are finished while a picture is drawn
    waiting_.push_back({frame, views});
    if (waiting_.size() > kMost) waiting_.pop_front();
}

ShownReplay::Drawn const& ShownReplay::draw(ShownFrame const& shown)
{
    FrameCommand const& moment = shown.moment;
    auto const is_before = [&](Kept const& k) { return k.frame->command.frame < moment.frame; };
    // The next frame may have been finished while this one was drawn for the first time.
    while (!waiting_.empty() && is_before(waiting_.front())) waiting_.pop_front();
    bool const fresh = !waiting_.empty() && waiting_.front().frame->command.frame == moment.frame;
    if (fresh) {
        taken_ = waiting_.front();
        waiting_.pop_front();
    }
    if (!taken_.frame || taken_.frame->command.frame != moment.frame)
        throw gi::InputError("the recording shows a frame that it does not have",
                             fmt::format("frame {}", moment.frame), "record the walk again");
    std::vector<WindowShown> parts = shown.windows;
    if (parts.empty()) {
        parts.push_back({shown.surfaces_scale, std::vector<int>(moment.views.size())});
        std::iota(parts[0].views.begin(), parts[0].views.end(), 0);
    }
    while (windows_.size() < parts.size()) windows_.emplace_back().hash_pictures();
    drawn_.views = taken_.views;
    drawn_.eyes.assign(moment.views.size(), {});
    for (std::size_t w = 0; w < parts.size(); ++w) {
        ShownViews& views = windows_[w];
        if (fresh || !views.has_frame()) views.take(taken_.frame, parts[w].views);
        if (parts[w].surfaces_scale > 0 && !views.make_ready())
            throw gi::InputError("surfaces cannot be drawn again", views.why_no_surfaces(),
                                 "replay without --shown");
        views.begin(parts[w].surfaces_scale, &moment, drive_);
        for (int const k : parts[w].views) {
            EyeView const eye = views.eye(k, &moment.views[std::size_t(k)].camera);
            // Of two windows that have both eyes each, the first shows the left one and the second the right one.
            if (k != taken_.views.left || drawn_.eyes[std::size_t(k)].picture.texture == 0)
                drawn_.eyes[std::size_t(k)] = eye;
        }
    }
    return drawn_;
}

std::uint64_t ShownReplay::hash() const
{
    std::vector<ShownViews const*> all;
    for (ShownViews const& w : windows_) all.push_back(&w);
    return shown_hash(all);
}

std::vector<unsigned char> ShownReplay::bytes(EyeView const& left, EyeView const& right, Arrangement const& a,
                                              DisplaySettings settings)
{
    settings.stereo = a.mode;
    if (!target_ || target_->shown().size_px != a.size_px)
        target_.emplace(TextureTarget::Format::bytes, a.size_px);
    // As Presenter does.
    bool const is_alone = a.mode == StereoMode::off;
    if (settings.comparison == Comparison::off && (left.is_drawn || (!is_alone && right.is_drawn))) {
        if (!surface_display_) surface_display_.emplace();
        TextureTarget const& l = surface_display_->encoded({0, 0}, pass_, left, settings);
        TextureTarget const& r = is_alone ? l : surface_display_->encoded({0, 1}, pass_, right, settings);
        SurfaceDisplay::compose(pass_, target_->target(), l, r, settings);
    } else {
        pass_.draw(target_->target(), left, right, settings);
    }
    return read_bytes(target_->target());
}

gi::Picture ShownReplay::linear(ShownPicture const& shown)
{
    if (shown.texture == 0) return {};
    gi::Picture p{shown.size_px.x, shown.size_px.y, {}, {}};
    std::vector<float>& rgb = p.add("color", 3).data;
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(shown.texture, 0, GL_RGB, GL_FLOAT, GLsizei(rgb.size() * sizeof(float)), rgb.data());
    return p;
}

} // namespace viewer
