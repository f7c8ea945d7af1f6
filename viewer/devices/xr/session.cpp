#include "viewer/devices/xr/session.h"

#include "gi/core/error.h"
#include "viewer/devices/xr/actions.h"
#include "viewer/devices/xr/eye_images.h"
#include "viewer/devices/xr/graphics.h"
#include "viewer/devices/xr/mask_reader.h"
#include "viewer/devices/xr/pose_math.h"
#include "viewer/devices/xr/spaces.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <limits>
#include <thread>

namespace viewer {
namespace {

constexpr XrViewStateFlags kWholePose = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;

double steady_now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// That this thread has worked.
double thread_cpu_s()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
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
    bool acquire_images();
    std::optional<std::vector<HmdView>> views_at(XrTime time);
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
    std::vector<std::unique_ptr<EyeImages>> images; ///< of each view

    HmdPhase phase = HmdPhase::idle;
    std::string why;
    bool is_running = false;                        ///< between xrBeginSession and xrEndSession
    std::optional<XrTime> frame_time;               ///< of the begun frame
    XrTime last_time = 0;                           ///< of the previous frame
    std::vector<HmdView> last_views;                ///< last known views
    std::vector<HmdView> shown;                     ///< that the images' contents were drawn for
    bool shows_depths = false;                      ///< they have depths
    double located_cpu_s = 0;                       ///< thread_cpu_s() when views were requested last
    double pose_age_s = 0, pose_cpu_s = 0;
    HmdCounts counts;
};

HmdSession::Parts::Parts(GlContext const* context, HmdOptions const& options)
    : runtime(context ? path_of(*context) : PicturePath::none, options)
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
    std::int64_t const depths =
        runtime.uses(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME) ? choose_depth_format(formats) : 0;
    HmdInfo const& info = runtime.info;
    for (int eye = 0; eye < 2; ++eye)
        images.push_back(std::make_unique<EyeImages>(session.handle, format, depths, info.width, info.height));
    for (int eye = 0; eye < 2 && info.inset_width > 0; ++eye)
        images.push_back(
            std::make_unique<EyeImages>(session.handle, format, depths, info.inset_width, info.inset_height));
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
        begin_info.primaryViewConfigurationType = runtime.views();
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

std::optional<std::vector<HmdView>> HmdSession::Parts::views_at(XrTime time)
{
    XrViewLocateInfo where{};
    where.type = XR_TYPE_VIEW_LOCATE_INFO;
    where.viewConfigurationType = runtime.views();
    where.displayTime = time;
    where.space = spaces->base();
    XrViewState state{};
    state.type = XR_TYPE_VIEW_STATE;
    XrView empty{};
    empty.type = XR_TYPE_VIEW;
    std::vector<XrView> found(images.size(), empty);
    std::uint32_t count = 0;
    double const asked_s = steady_now_s();
    located_cpu_s = thread_cpu_s();
    check(xrLocateViews(session.handle, &where, &state, std::uint32_t(found.size()), &count, found.data()),
          "xrLocateViews");
    if (count != found.size() || (state.viewStateFlags & kWholePose) != kWholePose) return std::nullopt;
    std::vector<HmdView> views;
    for (std::size_t v = 0; v < found.size(); ++v) {
        HmdRawView const raw = raw_of(found[v]);
        if (!spans_view(raw)) return std::nullopt;
        RoomPose const room_from_eye = spaces->room_from_space() * pose_of(raw);
        bool const is_inset = v >= 2;
        views.push_back({eye_camera(HmdEye(v % 2), room_from_eye, tangents(raw)),
                         is_inset ? runtime.info.inset_width : runtime.info.width,
                         is_inset ? runtime.info.inset_height : runtime.info.height, raw, spaces->moves(),
                         asked_s});
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
    } else {
        ++counts.without_pose;
    }
    frame.views = last_views;
    frame.should_render = state.shouldRender && !last_views.empty();
    return frame;
}

bool HmdSession::Parts::acquire_images()
{
    return std::ranges::all_of(images, [](auto const& view) { return view->acquire(); });
}

/// Acquires all images, then draws all, then shows all, so that the eyes never see different pictures.
bool HmdSession::Parts::draw(HmdPicture const& picture)
{
    if (picture.views.size() != images.size() || picture.textures.size() != images.size())
        throw std::logic_error("HmdSession: a picture of another number of views");
    if (!acquire_images()) return false;
    shows_depths = picture.depths.size() == images.size() &&
                   std::ranges::all_of(picture.depths, [](ShownDepth const& d) { return d.texture != 0; }) &&
                   images[0]->has_depths();
    for (std::size_t v = 0; v < images.size(); ++v)
        pass->draw(picture.textures[v], picture.values, picture.first_row, images[v]->target(),
                   shows_depths ? picture.depths[v] : ShownDepth{});
    for (auto const& view : images) view->release();
    shown = picture.views;
    return true;
}

void HmdSession::Parts::end(HmdPicture const* fresh, bool with_picture)
{
    bool const is_fresh = fresh && draw(*fresh);
    if (fresh && !is_fresh) ++counts.late_images;
    bool const has_layer = with_picture && !shown.empty();
    std::vector<XrCompositionLayerProjectionView> views(shown.size());
    std::vector<XrCompositionLayerDepthInfoKHR> depths(shown.size());
    for (std::size_t v = 0; v < views.size(); ++v) {
        views[v].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
        views[v].pose = spaces->moved_on(shown[v].raw, shown[v].space);
        views[v].fov = fov_of(shown[v].raw);
        views[v].subImage = images[v]->shown();
        if (!shows_depths) continue;
        depths[v].type = XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR;
        depths[v].subImage = images[v]->shown_depths();
        depths[v].minDepth = 0;
        depths[v].maxDepth = 1;
        depths[v].nearZ = std::numeric_limits<float>::infinity(); // of minDepth: depths are reversed
        depths[v].farZ = EyePass::kNear_m;
        views[v].next = &depths[v];
    }
    XrCompositionLayerProjection layer{};
    layer.type = XR_TYPE_COMPOSITION_LAYER_PROJECTION;
    layer.space = spaces->base();
    layer.viewCount = std::uint32_t(views.size());
    layer.views = views.data();
    auto const* const layers = reinterpret_cast<XrCompositionLayerBaseHeader const*>(&layer);
    XrFrameEndInfo info{};
    info.type = XR_TYPE_FRAME_END_INFO;
    info.displayTime = *frame_time;
    info.environmentBlendMode = runtime.blend_mode();
    info.layerCount = has_layer ? 1 : 0;
    info.layers = has_layer ? &layers : nullptr;
    frame_time.reset();
    if (is_fresh) {
        pose_age_s = steady_now_s() - shown[0].pose_s;
        pose_cpu_s = thread_cpu_s() - located_cpu_s;
    }
    check(xrEndFrame(session.handle, &info), "xrEndFrame");
    ++(is_fresh ? counts.pictures : has_layer ? counts.repeated : counts.empty);
    if (is_fresh && shows_depths) ++counts.with_depth;
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

std::optional<std::vector<HmdView>> HmdSession::latest_views(HmdFrame const& frame)
{
    return parts_->guarded([&] {
        if (parts_->frame_time) parts_->acquire_images(); // if they are late, end_frame waits on
        return parts_->views_at(frame.xr_time);
    });
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

bool HmdSession::takes_depths() const
{
    auto const& images = parts_->images;
    return !images.empty() && images[0]->has_depths();
}

double HmdSession::pose_age_s() const { return parts_->pose_age_s; }

double HmdSession::pose_cpu_s() const { return parts_->pose_cpu_s; }

HmdInfo const& HmdSession::info() const { return parts_->runtime.info; }

HmdCounts const& HmdSession::counts() const { return parts_->counts; }

} // namespace viewer
