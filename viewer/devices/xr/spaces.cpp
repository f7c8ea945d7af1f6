#include "viewer/devices/xr/spaces.h"

#include "viewer/devices/xr/actions.h"
#include "viewer/devices/xr/pose_math.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

XrSpace make_space(XrSession session, XrReferenceSpaceType type)
{
    XrReferenceSpaceCreateInfo create{};
    create.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    create.referenceSpaceType = type;
    create.poseInReferenceSpace.orientation.w = 1;
    XrSpace space = XR_NULL_HANDLE;
    check(xrCreateReferenceSpace(session, &create, &space), "xrCreateReferenceSpace");
    return space;
}

} // namespace

Spaces::Spaces(XrSession session, HmdOptions const& options)
{
    auto const offered = list_of(XR_REFERENCE_SPACE_TYPE_LOCAL, "xrEnumerateReferenceSpaces",
                                 [&](auto capacity, auto* n, auto* items) {
                                     return xrEnumerateReferenceSpaces(session, capacity, n, items);
                                 });
    bool const is_stage =
        options.space == HmdSpace::stage &&
        std::find(offered.begin(), offered.end(), XR_REFERENCE_SPACE_TYPE_STAGE) != offered.end();
    type_ = is_stage ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
    floor_m_ = is_stage ? 0 : options.eye_height_m;
    description_ = is_stage ? "stage" : fmt::format("local, eyes {} m above the floor", options.eye_height_m);
    room_from_space_.position.y = floor_m_;
    base_ = make_space(session, type_);
    head_ = make_space(session, XR_REFERENCE_SPACE_TYPE_VIEW);
}

std::optional<RoomPose> Spaces::head(XrTime time) const { return locate(head_, base_, room_from_space_, time); }

bool Spaces::recentre(XrTime time)
{
    auto const head_in_space = locate(head_, base_, {}, time);
    if (head_in_space) room_from_space_ = centred(*head_in_space, floor_m_);
    return head_in_space.has_value();
}

void Spaces::remember_head(XrTime asked, XrTime time)
{
    constexpr std::size_t kKept = 16;
    if (heads_.size() == kKept) heads_.erase(heads_.begin());
    if (auto const pose = locate(head_, base_, {}, time)) heads_.push_back({asked, time, *pose});
}

/// Returns old space from new. Frames between the change and its event already use the new space.
std::optional<RoomPose> Spaces::found_by_head(XrTime change) const
{
    auto const before =
        std::find_if(heads_.rbegin(), heads_.rend(), [&](SeenHead const& seen) { return seen.asked < change; });
    if (before == heads_.rend()) return std::nullopt;
    auto const now = locate(head_, base_, {}, before->time);
    if (!now) return std::nullopt;
    return before->space_from_head * inverse(*now);
}

bool Spaces::take(XrEventDataReferenceSpaceChangePending const& change)
{
    if (change.referenceSpaceType != type_) return false;
    auto const [q, p] = change.poseInPreviousSpace;
    std::optional<RoomPose> old_from_new;
    if (change.poseValid) old_from_new = pose_of({q.x, q.y, q.z, q.w}, {p.x, p.y, p.z});
    pending_.push_back({change.changeTime, old_from_new});
    return true;
}

void Spaces::apply_until(XrTime time)
{
    while (!pending_.empty() && pending_.front().time <= time) {
        auto const& [change, told] = pending_.front();
        moves_.push_back(told ? told : found_by_head(change));
        heads_.clear(); // they refer to the old space
        pending_.erase(pending_.begin());
        room_from_space_ = {{0, floor_m_, 0}, {1, 0, 0, 0}};
    }
}

XrPosef Spaces::moved_on(HmdRawView const& view, std::uint64_t space) const
{
    XrPosef as_it_was{{view.rotation[0], view.rotation[1], view.rotation[2], view.rotation[3]},
                      {view.position[0], view.position[1], view.position[2]}};
    if (space >= moves_.size()) return as_it_was;
    RoomPose pose = pose_of(view);
    for (std::size_t i = space; i < moves_.size(); ++i)
        if (moves_[i]) pose = inverse(*moves_[i]) * pose;
    auto const& [p, q] = pose;
    return {{float(q.x), float(q.y), float(q.z), float(q.w)}, {float(p.x), float(p.y), float(p.z)}};
}

} // namespace viewer
