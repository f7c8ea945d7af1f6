#include "viewer/devices/xr/actions.h"

#include "viewer/devices/xr/pose_math.h"

#include <cstdio>
#include <map>

namespace viewer {
namespace {

constexpr std::array<char const*, 2> kHands{"/user/hand/left", "/user/hand/right"};

enum class What { move, select, trigger, menu };

struct Binding {
    What what;
    char const* input;
    int hand = -1; ///< 0 left, 1 right, -1 both
};

struct Profile {
    char const* path;
    std::vector<Binding> bindings;
};

std::vector<Profile> const& profiles()
{
    static std::vector<Profile> const all{
        {"/interaction_profiles/khr/simple_controller",
         {{What::select, "select/click"}, {What::trigger, "select/click"}, {What::menu, "menu/click"}}},
        {"/interaction_profiles/oculus/touch_controller",
         {{What::move, "thumbstick"},
          {What::select, "x/click", 0},
          {What::select, "a/click", 1},
          {What::trigger, "trigger/value"},
          {What::menu, "menu/click", 0},
          {What::menu, "b/click", 1}}},
        {"/interaction_profiles/valve/index_controller",
         {{What::move, "thumbstick"},
          {What::select, "a/click"},
          {What::trigger, "trigger/value"},
          {What::menu, "b/click"}}},
        {"/interaction_profiles/htc/vive_controller",
         {{What::move, "trackpad"},
          {What::select, "trackpad/click"},
          {What::trigger, "trigger/value"},
          {What::menu, "menu/click"}}},
        {"/interaction_profiles/microsoft/motion_controller",
         {{What::move, "thumbstick"},
          {What::select, "trackpad/click"},
          {What::trigger, "trigger/value"},
          {What::menu, "menu/click"}}},
    };
    return all;
}

} // namespace

std::optional<RoomPose> locate(XrSpace what, XrSpace space, RoomPose const& room_from_space, XrTime time)
{
    XrSpaceLocation at{};
    at.type = XR_TYPE_SPACE_LOCATION;
    check(xrLocateSpace(what, space, time, &at), "xrLocateSpace");
    constexpr XrSpaceLocationFlags kKnown =
        XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    if ((at.locationFlags & kKnown) != kKnown) return std::nullopt;
    auto const [q, p] = at.pose;
    return room_from_space * pose_of({q.x, q.y, q.z, q.w}, {p.x, p.y, p.z});
}

Actions::Actions(XrInstance instance, XrSession session, HmdEyeTracking eye_tracking)
    : instance_(instance), session_(session)
{
    XrActionSetCreateInfo create{};
    create.type = XR_TYPE_ACTION_SET_CREATE_INFO;
    std::snprintf(create.actionSetName, sizeof create.actionSetName, "viewer");
    std::snprintf(create.localizedActionSetName, sizeof create.localizedActionSetName, "Viewer");
    check(xrCreateActionSet(instance, &create, &set_), "xrCreateActionSet");
    try {
        for (std::size_t h = 0; h < 2; ++h) hand_path_[h] = path(kHands[h]);
        aim_ = make_action("point", "Point", XR_ACTION_TYPE_POSE_INPUT);
        grip_ = make_action("hand", "Hand", XR_ACTION_TYPE_POSE_INPUT);
        move_ = make_action("move", "Move", XR_ACTION_TYPE_VECTOR2F_INPUT);
        select_ = make_action("select", "Answer", XR_ACTION_TYPE_BOOLEAN_INPUT);
        trigger_ = make_action("trigger", "Trigger", XR_ACTION_TYPE_BOOLEAN_INPUT);
        menu_ = make_action("menu", "Menu", XR_ACTION_TYPE_BOOLEAN_INPUT);
        suggest();
        if (eye_tracking == HmdEyeTracking::on) {
            gaze_ = make_action("gaze", "Gaze", XR_ACTION_TYPE_POSE_INPUT, false);
            suggest("/interaction_profiles/ext/eye_gaze_interaction",
                    {{gaze_, path("/user/eyes_ext/input/gaze_ext/pose")}});
        }
        XrSessionActionSetsAttachInfo attach{};
        attach.type = XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO;
        attach.countActionSets = 1;
        attach.actionSets = &set_;
        check(xrAttachSessionActionSets(session, &attach), "xrAttachSessionActionSets");
        for (std::size_t h = 0; h < 2; ++h)
            for (auto const& [action, space] : {std::pair{aim_, &aim_space_[h]}, {grip_, &grip_space_[h]}}) {
                XrActionSpaceCreateInfo place{};
                place.type = XR_TYPE_ACTION_SPACE_CREATE_INFO;
                place.action = action;
                place.subactionPath = hand_path_[h];
                place.poseInActionSpace.orientation.w = 1;
                check(xrCreateActionSpace(session, &place, space), "xrCreateActionSpace");
            }
        if (gaze_ == XR_NULL_HANDLE) return;
        XrActionSpaceCreateInfo eyes{};
        eyes.type = XR_TYPE_ACTION_SPACE_CREATE_INFO;
        eyes.action = gaze_;
        eyes.poseInActionSpace.orientation.w = 1;
        check(xrCreateActionSpace(session, &eyes, &gaze_space_), "xrCreateActionSpace");
    } catch (...) {
        xrDestroyActionSet(set_); // also destroys its actions; the session destroys the spaces
        throw;
    }
}

Actions::~Actions() { xrDestroyActionSet(set_); }

XrAction Actions::make_action(char const* action_name, char const* shown_name, XrActionType type, bool hands) const
{
    XrActionCreateInfo create{};
    create.type = XR_TYPE_ACTION_CREATE_INFO;
    std::snprintf(create.actionName, sizeof create.actionName, "%s", action_name);
    std::snprintf(create.localizedActionName, sizeof create.localizedActionName, "%s", shown_name);
    create.actionType = type;
    create.countSubactionPaths = hands ? 2 : 0;
    create.subactionPaths = hand_path_.data();
    XrAction action = XR_NULL_HANDLE;
    check(xrCreateAction(set_, &create, &action), "xrCreateAction");
    return action;
}

XrPath Actions::path(std::string const& text) const
{
    XrPath found = XR_NULL_PATH;
    check(xrStringToPath(instance_, text.c_str(), &found), "xrStringToPath");
    return found;
}

void Actions::suggest() const
{
    std::map<What, XrAction> const action{
        {What::move, move_}, {What::select, select_}, {What::trigger, trigger_}, {What::menu, menu_}};
    for (Profile const& profile : profiles()) {
        std::vector<XrActionSuggestedBinding> bindings;
        for (int h = 0; h < 2; ++h) {
            std::string const hand = kHands[std::size_t(h)];
            bindings.push_back({aim_, path(hand + "/input/aim/pose")});
            bindings.push_back({grip_, path(hand + "/input/grip/pose")});
            for (Binding const& b : profile.bindings)
                if (b.hand < 0 || b.hand == h)
                    bindings.push_back({action.at(b.what), path(hand + "/input/" + b.input)});
        }
        suggest(profile.path, bindings);
    }
}

void Actions::suggest(char const* profile, std::vector<XrActionSuggestedBinding> const& bindings) const
{
    XrInteractionProfileSuggestedBinding suggested{};
    suggested.type = XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING;
    suggested.interactionProfile = path(profile);
    suggested.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    suggested.suggestedBindings = bindings.data();
    check(xrSuggestInteractionProfileBindings(instance_, &suggested), profile);
}

std::optional<Actions::Gaze> Actions::gaze(XrSpace head, XrTime time) const
{
    if (gaze_space_ == XR_NULL_HANDLE) return {};
    XrActionStateGetInfo get{};
    get.type = XR_TYPE_ACTION_STATE_GET_INFO;
    get.action = gaze_;
    XrActionStatePose state{};
    state.type = XR_TYPE_ACTION_STATE_POSE;
    check(xrGetActionStatePose(session_, &get, &state), "xrGetActionStatePose");
    if (!state.isActive) return {};
    XrEyeGazeSampleTimeEXT sample{};
    sample.type = XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT;
    XrSpaceLocation at{};
    at.type = XR_TYPE_SPACE_LOCATION;
    at.next = &sample;
    check(xrLocateSpace(gaze_space_, head, time, &at), "xrLocateSpace");
    Gaze gaze{{}, sample.time};
    auto const [q, p] = at.pose;
    glm::dvec3 const along = pose_of({q.x, q.y, q.z, q.w}, {p.x, p.y, p.z}).rotation * glm::dvec3(0, 0, -1);
    gaze.state.is_valid = (at.locationFlags & XR_SPACE_LOCATION_ORIENTATION_VALID_BIT) != 0 && along.z < 0;
    if (gaze.state.is_valid) gaze.state.tangent = glm::dvec2(along.x, along.y) / -along.z;
    return gaze;
}

void Actions::read_profiles()
{
    for (std::size_t h = 0; h < 2; ++h) {
        XrInteractionProfileState state{};
        state.type = XR_TYPE_INTERACTION_PROFILE_STATE;
        check(xrGetCurrentInteractionProfile(session_, hand_path_[h], &state), "xrGetCurrentInteractionProfile");
        hands_[h].profile.clear();
        if (state.interactionProfile == XR_NULL_PATH) continue;
        char text[XR_MAX_PATH_LENGTH] = "";
        std::uint32_t length = 0;
        check(xrPathToString(instance_, state.interactionProfile, sizeof text, &length, text), "xrPathToString");
        hands_[h].profile = text;
    }
}

XrActionStateGetInfo Actions::of_hand(XrAction action, std::size_t hand) const
{
    XrActionStateGetInfo get{};
    get.type = XR_TYPE_ACTION_STATE_GET_INFO;
    get.action = action;
    get.subactionPath = hand_path_[hand];
    return get;
}

bool Actions::is_pressed(XrAction action, std::size_t hand) const
{
    XrActionStateGetInfo const get = of_hand(action, hand);
    XrActionStateBoolean state{};
    state.type = XR_TYPE_ACTION_STATE_BOOLEAN;
    check(xrGetActionStateBoolean(session_, &get, &state), "xrGetActionStateBoolean");
    return state.isActive && state.currentState;
}

void Actions::read_buttons()
{
    XrActiveActionSet const active{set_, XR_NULL_PATH};
    XrActionsSyncInfo sync{};
    sync.type = XR_TYPE_ACTIONS_SYNC_INFO;
    sync.countActiveActionSets = 1;
    sync.activeActionSets = &active;
    check(xrSyncActions(session_, &sync), "xrSyncActions"); // without focus all actions are inactive
    for (std::size_t h = 0; h < 2; ++h) {
        HmdHand& hand = hands_[h];
        hand.select = is_pressed(select_, h);
        hand.trigger = is_pressed(trigger_, h);
        hand.menu = is_pressed(menu_, h);
        XrActionStateGetInfo const get = of_hand(move_, h);
        XrActionStateVector2f move{};
        move.type = XR_TYPE_ACTION_STATE_VECTOR2F;
        check(xrGetActionStateVector2f(session_, &get, &move), "xrGetActionStateVector2f");
        hand.move = move.isActive ? glm::dvec2(move.currentState.x, move.currentState.y) : glm::dvec2(0);
    }
}

std::array<Actions::Hand, 2> Actions::hands(XrSpace space, RoomPose const& room_from_space, XrTime time) const
{
    std::array<Hand, 2> found;
    for (std::size_t h = 0; h < 2; ++h) {
        found[h].state = hands_[h];
        if (hands_[h].profile.empty()) continue;
        found[h].state.aim = locate(aim_space_[h], space, room_from_space, time);
        found[h].grip = locate(grip_space_[h], space, room_from_space, time);
    }
    return found;
}

} // namespace viewer
