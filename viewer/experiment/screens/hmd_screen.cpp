#include "viewer/experiment/screens/hmd_screen.h"

#include "gi/core/error.h"
#include "viewer/engine/live/navigation.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <thread>

namespace viewer {
namespace {

using Clock = InputEvent::Clock;
constexpr std::chrono::seconds kPatience{20};     ///< without a session
constexpr std::chrono::milliseconds kUnseen{100}; ///< without a visible frame
constexpr double kTextWidth = 0.8; ///< width of the floating text: twice the tangent of half its angle

/// The headset has its own rate, so the window must not wait for a monitor.
WindowSettings beside_headset(WindowSettings settings)
{
    settings.swap_interval = 0;
    return settings;
}

glm::ivec2 size_of(HmdView const& view) { return {view.width, view.height}; }

} // namespace

HmdScreen::HmdScreen(ScreenSettings const& settings, HmdOptions const& headset, gi::Report& report)
    : context_(report, beside_headset(settings.window)),
      last_look_(Clock::now()),
      report_(report),
      keeper_(&context_.gl(), headset)
{
    if (!context_.window)
        throw gi::InputError("no window beside the headset", "there is no display server for text and keys",
                             "set DISPLAY, or start one (Xvfb)");
    panel_ = std::make_unique<Panel>(*context_.window, settings.font_px);
    HmdSession* session = nullptr;
    if (next_frame(session)) session->end_frame();
}

HmdScreen::~HmdScreen()
{
    context_.gl().make_current();
    panel_.reset();
}

glm::ivec2 HmdScreen::size_px() const { return context_.window->framebuffer_px(); }
double HmdScreen::refresh_hz() const { return frame_.period_s > 0 ? 1 / frame_.period_s : 0; }

std::vector<std::pair<std::string, std::string>> HmdScreen::about() const
{
    glm::ivec2 const px = frame_.views.empty() ? glm::ivec2(0) : size_of(frame_.views[0]);
    return {{"display", fmt::format("headset, {} x {} px an eye", px.x, px.y)},
            {"window_px", fmt::format("{} x {}", size_px().x, size_px().y)},
            {"opengl", context_.gl().description()}};
}

/// Next frame that will be visible; none if no frame is visible for a while (headset not worn).
/// Reads input meanwhile.
std::optional<HmdFrame> HmdScreen::next_frame(HmdSession*& session)
{
    auto const begun = Clock::now();
    int const losses = keeper_.losses();
    while (true) {
        poll_windows();
        for (InputEvent& e : context_.window->take_events()) input_.push_back(e);
        gamepads_.poll(input_);
        session = keeper_.poll();
        if (keeper_.losses() != losses)
            throw gi::InputError("the headset was lost", keeper_.trouble(), "start it, and go on with --resume");
        if (session != nullptr)
            if (std::optional<HmdFrame> frame = session->begin_frame()) {
                look(*frame);
                if (frame->should_render) return frame;
                session->end_frame();
            }
        auto const waited = Clock::now() - begun;
        if (session != nullptr && waited > kUnseen) return {};
        if (session == nullptr && waited > kPatience)
            throw gi::InputError("the headset has no session", keeper_.trouble(), "check its runtime");
        if (session == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

/// Button states are sampled when a frame begins.
void HmdScreen::look(HmdFrame const& frame)
{
    auto const now = Clock::now();
    longest_look_ms_ =
        std::max(longest_look_ms_, std::chrono::duration<double, std::milli>(now - last_look_).count());
    last_look_ = now;
    for (int hand = 0; hand < 2; ++hand) {
        HmdHand const &was = hands_[std::size_t(hand)], &is = frame.hands[std::size_t(hand)];
        bool const before[] = {was.select, was.trigger, was.menu}, after[] = {is.select, is.trigger, is.menu};
        for (int code = 0; code < 3; ++code) {
            if (before[code] == after[code]) continue;
            InputEvent e;
            e.kind = InputKind::hand_button;
            e.action = after[code] ? InputAction::press : InputAction::release;
            e.device = hand;
            e.code = code;
            e.time = now;
            input_.push_back(e);
        }
    }
    hands_ = frame.hands;
    if (frame.gaze && frame.gaze->time_s > last_gaze_s_) { // a tracker may be slower than the display
        last_gaze_s_ = frame.gaze->time_s;
        double const scale = px_per_tangent();
        gaze_.push_back({last_gaze_s_, scale * frame.gaze->tangent.x, -scale * frame.gaze->tangent.y, NAN,
                         frame.gaze->is_valid});
    }
    if (!start_ && frame.tracked.head) start_ = frame.tracked.head->position;
    frame_ = frame;
}

double HmdScreen::px_per_tangent() const { return size_px().x / kTextWidth; }

std::vector<std::pair<std::string, std::string>> HmdScreen::gaze_about() const
{
    return {{"gaze_source", "openxr: XR_EXT_eye_gaze_interaction"},
            {"gaze_rate_hz", "once a frame"},
            {"gaze_px_per_tangent", fmt::format("{:.3f}", px_per_tangent())}};
}

gi::dmat4 HmdScreen::world_from_room() const
{
    Navigation const upright(world_from_camera_, 1, gi::dvec3(world_from_camera_[3]));
    return upright.world_from_room() * glm::translate(gi::dmat4(1), -start_.value_or(gi::dvec3{0}));
}

std::vector<ViewCommand> HmdScreen::own_views(gi::dmat4 const& world_from_camera, double)
{
    world_from_camera_ = world_from_camera;
    std::vector<ViewCommand> views;
    if (frame_.views.empty()) return views; // no frame yet
    for (std::size_t eye = 0; eye < 2; ++eye) {
        gi::Camera camera = frame_.views[eye].camera;
        camera.world_from_camera = world_from_room() * camera.world_from_camera;
        glm::ivec2 const px = size_of(frame_.views[eye]);
        views.push_back({eye == 0 ? "left eye" : "right eye", camera, px.x, px.y, eye == 0 ? -1 : 0});
    }
    return views;
}

void HmdScreen::draw_text(ScreenContent const& content)
{
    clear(target_of(*context_.window), ScreenContent::kGrey);
    if (!content.text) return;
    panel_->begin();
    content.text(size_px());
    panel_->finish();
    panel_->draw();
}

/// Copies the window's text in front of both eyes, centred straight ahead at infinity.
void HmdScreen::place_text(HmdFrame const& frame)
{
    glm::ivec2 const from = size_px();
    for (std::size_t eye = 0; eye < 2; ++eye) {
        DrawTarget const to = eyes_.target(eye);
        gi::ViewTangents const t = frame.views[eye].camera.off_axis.value_or(gi::ViewTangents{-1, 1, -1, 1});
        double const px_per_tangent = to.size_px.x / (t.right - t.left);
        int const width = int(kTextWidth * px_per_tangent), height = width * from.y / std::max(1, from.x);
        int const x = int(-t.left * px_per_tangent) - width / 2;
        int const y = int(t.top / (t.top - t.bottom) * to.size_px.y) - height / 2; // from the top
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.framebuffer);
        // The window has its bottom row first, the eye its top row.
        glBlitFramebuffer(0, 0, from.x, from.y, x, y + height, x + width, y, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void HmdScreen::make_ready(ScreenPane const& pane)
{
    if (pane.frame->result.views.size() != 2) return;
    context_.gl().make_current();
    eyes_.take(pane.frame);
    taken_ = pane.frame;
    eyes_.views().make_ready();
    eyes_.views().begin(surfaces_scale_.next(), nullptr, {});
    eyes_.draw({{std::nullopt, size_of(frame_.views[0])}, {std::nullopt, size_of(frame_.views[1])}},
               tone_settings(pane.frame->settings));
}

ScreenSwap HmdScreen::present(ScreenContent const& content)
{
    HmdSession* session = nullptr;
    std::optional<HmdFrame> const next = next_frame(session);
    context_.gl().make_current();
    draw_text(content);
    if (content.patch_size_px.x > 0 && !std::exchange(patch_told_, true))
        report_.lose("photodiode patches not shown: a headset has no place for them");
    if (!next) { // show it only in the window
        context_.window->swap();
        return {Clock::now(), Clock::now(), 1e3, "openxr_predicted"};
    }
    HmdFrame const& frame = *next;
    std::vector const sizes{size_of(frame.views[0]), size_of(frame.views[1])};
    auto const shown = content.panes.empty() ? nullptr : content.panes[0].frame;
    auto const begun = Clock::now();
    double scale = 0;
    if (shown && shown->result.views.size() == 2) {
        if (taken_ != shown) eyes_.take(shown);
        taken_ = shown;
        std::vector<ViewCommand> const views = own_views(world_from_camera_, 0);
        std::optional<FrameCommand> moment = content.panes[0].moment;
        if (moment) scale = surfaces_scale_.next();
        std::vector<EyeToDraw> eyes;
        for (std::size_t eye = 0; eye < views.size(); ++eye) {
            ViewCommand const& view = views[eye];
            eyes.push_back({shown->settings.reproject ? std::optional(view.camera) : std::nullopt,
                            {view.width, view.height}});
            if (moment && moment->views.size() == views.size()) moment->views[eye].camera = view.camera;
        }
        eyes_.views().begin(scale, moment ? &*moment : nullptr, {});
        eyes_.draw(eyes, tone_settings(shown->settings));
    } else {
        eyes_.clear(sizes, ScreenContent::kGrey);
    }
    if (content.text) place_text(frame);
    context_.window->swap();
    HmdPicture picture;
    picture.views = frame.views;
    picture.values = TextureValues::srgb;
    picture.first_row = FirstRow::top;
    picture.textures = eyes_.textures();
    session->end_frame(picture);
    Clock::time_point const seen{
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(frame.display_s))};
    ScreenSwap swap{seen, seen, 0.5e3 * frame.period_s, "openxr_predicted"};
    if (!(scale > 0)) return swap;
    ShownViews const& drawn = eyes_.views();
    swap.drawn = {char(drawn.drew_surfaces())};
    if (drawn.drew_surfaces()) {
        double const took_s = std::chrono::duration<double>(Clock::now() - begun).count();
        surfaces_scale_.measured(scale, std::max(took_s, eyes_.drawing_s()), frame.period_s);
    }
    if (drawn.draws_surfaces()) swap.drawn_scale = surfaces_scale_.next();
    if (!drawn.why_no_surfaces().empty() && !std::exchange(no_surfaces_told_, true))
        report_.lose("surfaces not drawn, pictures are reprojected", 1, drawn.why_no_surfaces());
    return swap;
}

void HmdScreen::wait_until(Clock::time_point time)
{
    do {
        HmdSession* session = nullptr;
        if (next_frame(session)) session->repeat_frame();
    } while (Clock::now() < time);
}

std::vector<InputEvent> HmdScreen::take_input() { return std::exchange(input_, {}); }

} // namespace viewer
