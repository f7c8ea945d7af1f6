#include "viewer/devices/xr/session.h"

#include "gi/core/error.h"
#include "viewer/devices/xr/actions.h"
#include "viewer/devices/xr/eye_images.h"
#include "viewer/devices/xr/graphics.h"
#include "viewer/devices/xr/mask_reader.h"
#include "viewer/devices/xr/pose_math.h"
#include "viewer/devices/xr/spaces.h"

#include <chrono>
#include <fmt/format.h>
#include <thread>

namespace viewer {
namespace {

constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr XrViewStateFlags kWholePose = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;

double steady_now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

HmdPhase phase_of(XrSessionState state)
{
    switch (state) {
    case XR_SESSION_STATE_READY:
        return HmdPhase::ready;
    case XR_SESSION_STATE_SYNCHRONIZED:
        return HmdPhase::synchronized;
    case XR_SESSION_STATE_VISIBLE:
        return HmdPhase::visible;
    case XR_SESSION_STATE_FOCUSED:
        return HmdPhase::focused;
    case XR_SESSION_STATE_STOPPING:
        return HmdPhase::stopping;
    case XR_SESSION_STATE_LOSS_PENDING:
        return HmdPhase::lost;
    case XR_SESSION_STATE_EXITING:
        return HmdPhase::ended;
    default:
        return HmdPhase::idle;
    }
}

HmdRawView raw_of(XrView const& view)
{
    auto const& [q, p] = view.pose;
    XrFovf const& f = view.fov;
    return {{q.x, q.y, q.z, q.w}, {p.x, p.y, p.z}, {f.angleLeft, f.angleRight, f.angleUp, f.angleDown}};
}

XrFovf fov_of(HmdRawView const& raw) { return {raw.fov_rad[0], raw.fov_rad[1], raw.fov_rad[2], raw.fov_rad[3]}; }

/// Owns the XrSession; destroyed after all objects that depend on it.
struct SessionHandle {
    XrSession handle = XR_NULL_HANDLE;
    ~SessionHandle()
    {
        if (handle != XR_NULL_HANDLE) xrDestroySession(handle);
    }
};

} // namespace

char const* name(HmdPhase phase)
{
    switch (phase) {
    case HmdPhase::idle:
        return "idle";
    case HmdPhase::ready:
        return "ready";
    case HmdPhase::synchronized:
        return "synchronized";
    case HmdPhase::visible:
        return "visible";
    case HmdPhase::focused:
        return "focused";
    case HmdPhase::stopping:
        return "stopping";
    case HmdPhase::lost:
        return "lost";
    case HmdPhase::ended:
        return "ended";
    }
    return "unknown";
}

struct HmdSession::Parts {
    Parts(GlContext const* context, HmdOptions const& options);
    ~Parts();

    void read_events();
    void take_state(XrSessionState state);
    std::optional<HmdFrame> begin();
    void end(HmdPicture const* fresh, bool with_picture);
    bool draw(HmdPicture const& picture);
    std::optional<std::array<HmdView, 2>> views_at(XrTime time);
    void add_bodies(HmdFrame& frame, XrTime time);
    void lose(std::string const& reason);
    /// Runs calls to the runtime; a failed call means the loss of the session.
    template <class Work>
    auto guarded(Work const& work) -> decltype(work());

    Runtime runtime;
    SessionHandle session;
    std::optional<Spaces> spaces;
    std::optional<Actions> actions;
    std::optional<MaskReader> masks;
    std::optional<EyePass> pass;
    std::array<std::unique_ptr<EyeImages>, 2> images;

    HmdPhase phase = HmdPhase::idle;
    std::string why;
    bool is_running = false;                        ///< between xrBeginSession and xrEndSession
    std::optional<XrTime> frame_time;               ///< of the begun frame
    XrTime last_time = 0;                           ///< of the previous frame
    std::array<HmdView, 2> last_views;              ///< last known views
    bool has_views = false;                         ///< last_views are valid
    std::optional<std::array<HmdRawView, 2>> shown; ///< views that the images' contents were drawn for
    std::uint64_t shown_space = 0;
    HmdCounts counts;
};

HmdSession::Parts::Parts(GlContext const* context, HmdOptions const& options)
    : runtime(context ? path_of(*context) : PicturePath::none, options.eye_tracking)
{
    if (options.eye_tracking == HmdEyeTracking::on && !runtime.info.tracks_gaze)
        throw gi::InputError("the headset does not track eyes",
                             runtime.info.system + " reports no supportsEyeGazeInteraction",
                             "use one that does, switch it on in its runtime, or go on without gaze");
    std::shared_ptr<void const> const binding = context ? graphics_binding(runtime, *context) : nullptr;
    XrSessionCreateInfo create{};
    create.type = XR_TYPE_SESSION_CREATE_INFO;
    create.next = binding.get();
    create.systemId = runtime.system();
    check(xrCreateSession(runtime.instance(), &create, &session.handle), "xrCreateSession");
    spaces.emplace(session.handle, options);
    runtime.info.space = spaces->description();
    actions.emplace(runtime.instance(), session.handle, options.eye_tracking);
    masks.emplace(runtime, session.handle);
    if (!context) return;
    auto const formats =
        list_of(std::int64_t{0}, "xrEnumerateSwapchainFormats", [&](auto capacity, auto* count, auto* items) {
            return xrEnumerateSwapchainFormats(session.handle, capacity, count, items);
        });
    std::int64_t const format = choose_format(formats);
    if (format == 0)
        throw gi::InputError("the OpenXR runtime supports no picture format of lightwell",
                             "it offers neither sRGB nor linear colours of OpenGL", "use another runtime");
    for (auto& eye : images)
        eye = std::make_unique<EyeImages>(session.handle, format, runtime.info.width, runtime.info.height);
    pass.emplace();
}

HmdSession::Parts::~Parts() = default;

void HmdSession::Parts::lose(std::string const& reason)
{
    phase = HmdPhase::lost;
    why = reason;
    is_running = false;
    frame_time.reset();
}

template <class Work>
auto HmdSession::Parts::guarded(Work const& work) -> decltype(work())
{
    try {
        if (phase != HmdPhase::lost && phase != HmdPhase::ended) return work();
    } catch (CallError const& e) {
        lose(e.what());
    }
    return decltype(work())();
}

void HmdSession::Parts::take_state(XrSessionState state)
{
    phase = phase_of(state);
    if (state == XR_SESSION_STATE_READY) {
        XrSessionBeginInfo begin_info{};
        begin_info.type = XR_TYPE_SESSION_BEGIN_INFO;
        begin_info.primaryViewConfigurationType = kStereo;
        check(xrBeginSession(session.handle, &begin_info), "xrBeginSession");
        is_running = true;
        masks->read();
    }
    if (state == XR_SESSION_STATE_STOPPING) {
        is_running = false;
        check(xrEndSession(session.handle), "xrEndSession");
    }
    if (state == XR_SESSION_STATE_LOSS_PENDING)
        lose("XR_SESSION_STATE_LOSS_PENDING: the runtime drops the session");
    if (state == XR_SESSION_STATE_EXITING) why = "the runtime has ended the session";
}

void HmdSession::Parts::read_events()
{
    while (phase != HmdPhase::lost && phase != HmdPhase::ended) {
        XrEventDataBuffer event{};
        event.type = XR_TYPE_EVENT_DATA_BUFFER;
        if (check(xrPollEvent(runtime.instance(), &event), "xrPollEvent") == XR_EVENT_UNAVAILABLE) return;
        switch (event.type) {
        case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED:
            take_state(reinterpret_cast<XrEventDataSessionStateChanged const&>(event).state);
            break;
        case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
            lose("XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING: the runtime is going away");
            break;
        case XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED:
            actions->read_profiles();
            break;
        case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING:
            if (spaces->take(reinterpret_cast<XrEventDataReferenceSpaceChangePending const&>(event)))
                ++counts.moved_spaces;
            break;
        case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
            masks->read();
            break;
        case XR_TYPE_EVENT_DATA_EVENTS_LOST:
            counts.lost_events += reinterpret_cast<XrEventDataEventsLost const&>(event).lostEventCount;
            break;
        default:
            break;
        }
    }
}

std::optional<std::array<HmdView, 2>> HmdSession::Parts::views_at(XrTime time)
{
    XrViewLocateInfo where{};
    where.type = XR_TYPE_VIEW_LOCATE_INFO;
    where.viewConfigurationType = kStereo;
    where.displayTime = time;
    where.space = spaces->base();
    XrViewState state{};
    state.type = XR_TYPE_VIEW_STATE;
    std::array<XrView, 2> found{};
    for (XrView& view : found) view.type = XR_TYPE_VIEW;
    std::uint32_t count = 0;
    check(xrLocateViews(session.handle, &where, &state, 2, &count, found.data()), "xrLocateViews");
    if (count != 2 || (state.viewStateFlags & kWholePose) != kWholePose) return std::nullopt;
    std::array<HmdView, 2> views;
    for (std::size_t e = 0; e < 2; ++e) {
        HmdRawView const raw = raw_of(found[e]);
        if (!spans_view(raw)) return std::nullopt;
        RoomPose const room_from_eye = spaces->room_from_space() * pose_of(raw);
        views[e] = {eye_camera(HmdEye(e), room_from_eye, tangents(raw)), runtime.info.width, runtime.info.height,
                    raw, spaces->moves()};
    }
    return views;
}

void HmdSession::Parts::add_bodies(HmdFrame& frame, XrTime time)
{
    actions->read_buttons();
    frame.pose_s = steady_now_s();
    frame.tracked.head = spaces->head(time);
    auto const hands = actions->hands(spaces->base(), spaces->room_from_space(), time);
    for (std::size_t h = 0; h < 2; ++h) frame.hands[h] = hands[h].state;
    frame.tracked.left_hand = hands[0].grip;
    frame.tracked.right_hand = hands[1].grip;
    // The present gaze: a prediction for the time of display would guess the next saccade.
    if (auto const gaze = actions->gaze(spaces->head_space(), runtime.xr_time(frame.pose_s))) {
        frame.gaze = gaze->state;
        frame.gaze->time_s = gaze->measured > 0 ? runtime.steady_s(gaze->measured) : frame.pose_s;
    }
}

std::optional<HmdFrame> HmdSession::Parts::begin()
{
    XrFrameState state{};
    state.type = XR_TYPE_FRAME_STATE;
    check(xrWaitFrame(session.handle, nullptr, &state), "xrWaitFrame");
    if (check(xrBeginFrame(session.handle, nullptr), "xrBeginFrame") == XR_FRAME_DISCARDED) ++counts.discarded;
    frame_time = last_time = state.predictedDisplayTime;
    spaces->apply_until(state.predictedDisplayTime);

    HmdFrame frame;
    frame.frame = counts.frames++;
    frame.xr_time = state.predictedDisplayTime;
    frame.display_s = runtime.steady_s(state.predictedDisplayTime);
    frame.period_s = double(state.predictedDisplayPeriod) * 1e-9;
    add_bodies(frame, state.predictedDisplayTime);
    spaces->remember_head(runtime.xr_time(frame.pose_s), state.predictedDisplayTime);
    if (auto const views = views_at(state.predictedDisplayTime)) {
        frame.has_pose = true;
        last_views = *views;
        has_views = true;
    } else {
        ++counts.without_pose;
    }
    frame.views = last_views;
    frame.should_render = state.shouldRender && has_views;
    return frame;
}

/// Acquires both images, then draws both, then shows both, so that the eyes never see different pictures.
bool HmdSession::Parts::draw(HmdPicture const& picture)
{
    for (auto const& eye : images)
        if (!eye->acquire()) return false;
    for (std::size_t e = 0; e < 2; ++e)
        pass->draw(picture.textures[e], picture.values, picture.first_row, images[e]->target());
    for (auto const& eye : images) eye->release();
    return true;
}

void HmdSession::Parts::end(HmdPicture const* fresh, bool with_picture)
{
    bool const is_fresh = fresh && draw(*fresh);
    if (fresh && !is_fresh) ++counts.late_images;
    if (is_fresh) {
        shown = {fresh->views[0].raw, fresh->views[1].raw};
        shown_space = fresh->views[0].space;
    }
    bool const has_layer = with_picture && shown.has_value();
    std::array<XrCompositionLayerProjectionView, 2> views{};
    for (std::size_t e = 0; has_layer && e < 2; ++e) {
        views[e].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
        views[e].pose = spaces->moved_on((*shown)[e], shown_space);
        views[e].fov = fov_of((*shown)[e]);
        views[e].subImage = images[e]->shown();
    }
    XrCompositionLayerProjection layer{};
    layer.type = XR_TYPE_COMPOSITION_LAYER_PROJECTION;
    layer.space = spaces->base();
    layer.viewCount = 2;
    layer.views = views.data();
    auto const* const layers = reinterpret_cast<XrCompositionLayerBaseHeader const*>(&layer);
    XrFrameEndInfo info{};
    info.type = XR_TYPE_FRAME_END_INFO;
    info.displayTime = *frame_time;
    info.environmentBlendMode = runtime.blend_mode();
    info.layerCount = has_layer ? 1 : 0;
    info.layers = has_layer ? &layers : nullptr;
    frame_time.reset();
    check(xrEndFrame(session.handle, &info), "xrEndFrame");
    ++(is_fresh ? counts.pictures : has_layer ? counts.repeated : counts.empty);
}

HmdSession::HmdSession(GlContext const& context, HmdOptions const& options) { start(&context, options); }

HmdSession::HmdSession(HmdOptions const& options) { start(nullptr, options); }

void HmdSession::start(GlContext const* context, HmdOptions const& options)
{
    if (!(options.eye_height_m >= 0.2 && options.eye_height_m <= 3))
        throw gi::InputError(fmt::format("an eye height of {} m", options.eye_height_m),
                             "eyes are 0.2 to 3 m above the floor", "give it in metres");
    try {
        parts_ = std::make_unique<Parts>(context, options);
    } catch (CallError const& e) {
        throw gi::InputError("the OpenXR runtime starts no session", e.what(),
                             "check the runtime's messages; restart it");
    }
}

HmdSession::~HmdSession() = default;

HmdPhase HmdSession::poll()
{
    parts_->guarded([&] { parts_->read_events(); });
    return parts_->phase;
}

HmdPhase HmdSession::phase() const { return parts_->phase; }

bool HmdSession::ended() const { return parts_->phase == HmdPhase::lost || parts_->phase == HmdPhase::ended; }

std::string const& HmdSession::why() const { return parts_->why; }

void HmdSession::request_exit()
{
    parts_->guarded([&] {
        if (parts_->is_running) {
            check(xrRequestExitSession(parts_->session.handle), "xrRequestExitSession");
        } else {
            parts_->phase = HmdPhase::ended;
            parts_->why = "ended before it began";
        }
    });
}

std::optional<HmdFrame> HmdSession::begin_frame()
{
    if (!parts_->pass || parts_->frame_time)
        throw std::logic_error("HmdSession::begin_frame: a tracker, or the previous frame has not ended");
    std::optional<HmdFrame> frame;
    if (parts_->is_running) frame = parts_->guarded([&] { return parts_->begin(); });
    if (!frame) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return frame;
}

std::optional<std::array<HmdView, 2>> HmdSession::latest_views(HmdFrame const& frame)
{
    return parts_->guarded([&] { return parts_->views_at(frame.xr_time); });
}

void HmdSession::end_frame(HmdPicture const& picture)
{
    parts_->guarded([&] {
        if (parts_->frame_time) parts_->end(&picture, true);
    });
}

void HmdSession::repeat_frame()
{
    parts_->guarded([&] {
        if (parts_->frame_time) parts_->end(nullptr, true);
    });
}

void HmdSession::end_frame()
{
    parts_->guarded([&] {
        if (parts_->frame_time) parts_->end(nullptr, false);
    });
}

std::optional<HmdFrame> HmdSession::poses(double steady_s)
{
    if (parts_->pass) throw std::logic_error("HmdSession::poses: a session with pictures has begin_frame");
    return parts_->guarded([&]() -> std::optional<HmdFrame> {
        if (!parts_->is_running) return std::nullopt;
        HmdFrame frame;
        frame.frame = parts_->counts.frames++;
        frame.xr_time = parts_->last_time = parts_->runtime.xr_time(steady_s);
        frame.display_s = steady_s;
        parts_->spaces->apply_until(frame.xr_time);
        parts_->add_bodies(frame, frame.xr_time);
        frame.has_pose = frame.tracked.head.has_value();
        if (!frame.has_pose) ++parts_->counts.without_pose;
        return frame;
    });
}

bool HmdSession::recentre()
{
    return parts_->guarded([&] { return parts_->last_time != 0 && parts_->spaces->recentre(parts_->last_time); });
}

RoomPose HmdSession::room_from_space() const { return parts_->spaces->room_from_space(); }

HiddenMask const& HmdSession::hidden(HmdEye eye) const { return parts_->masks->mask(eye); }

HmdInfo const& HmdSession::info() const { return parts_->runtime.info; }

HmdCounts const& HmdSession::counts() const { return parts_->counts; }

} // namespace viewer
