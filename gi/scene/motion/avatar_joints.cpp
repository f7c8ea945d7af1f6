#include "gi/scene/motion/avatar_joints.h"

#include "gi/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace gi {
namespace {

enum class Side { none, left, right };

/// A parsed joint name: "mixamorig:LeftForeArm", "LowerArm.L", "b_RightUpperArm_06" -> forearm,
/// lowerarm, upperarm and their sides.
struct JointName {
    Side side = Side::none;
    std::string part;
};

std::vector<std::string> words_of(std::string const& name)
{
    std::vector<std::string> words;
    bool open = false, lower_before = false;
    for (char const ch : name) {
        auto const c = static_cast<unsigned char>(ch);
        if (std::isalnum(c) == 0) {
            open = false;
            continue;
        }
        bool const upper = std::isupper(c) != 0;
        if (!open || (upper && lower_before)) words.emplace_back();
        words.back() += char(std::tolower(c));
        open = true;
        lower_before = !upper;
    }
    return words;
}

JointName parse_name(std::string const& name)
{
    static std::set<std::string> const noise{"b",      "c",   "j",        "bip",       "bip01",
                                             "bip001", "def", "org",      "mixamorig", "bone",
                                             "joint",  "jnt", "skeleton", "armature",  "human"};
    std::size_t const prefix = name.find_last_of(":|");
    JointName out;
    for (std::string word : words_of(prefix == std::string::npos ? name : name.substr(prefix + 1))) {
        for (auto const& [text, side] : {std::pair{"left", Side::left}, {"right", Side::right}})
            if (word.starts_with(text)) {
                out.side = side;
                word = word.substr(std::string(text).size());
            }
        if (word == "l" || word == "r") {
            out.side = word == "l" ? Side::left : Side::right;
            continue;
        }
        bool const number = std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
        if (!number && !noise.contains(word)) out.part += word;
    }
    return out;
}

/// Names in order of preference.
std::vector<std::string> const kHead{"head"};
std::vector<std::string> const kUpper{"upperarm", "arm", "uparm", "armupper", "shldrbend", "shldr", "shoulder"};
std::vector<std::string> const kLower{"forearm", "lowerarm", "armlower", "forearmbend", "elbow"};
std::vector<std::string> const kHand{"hand", "wrist", "palm", "palm2", "palm1"};
std::vector<std::string> const kThigh{"upperleg", "upleg", "thigh", "legupper", "thighbend", "hip", "leg"};
std::vector<std::string> const kShin{"lowerleg", "shin", "calf", "leglower", "shinbend", "knee", "leg"};
std::vector<std::string> const kFoot{"foot", "ankle"};

class Finder {
public:
    Finder(Scene const& scene, std::vector<std::int32_t> const& joints) : scene_(scene), joints_(joints)
    {
        std::sort(joints_.begin(), joints_.end()); // parents before children
        for (std::int32_t const j : joints_) names_.push_back(parse_name(node(j).name));
    }

    AvatarJoints find(AvatarNames const& names)
    {
        AvatarJoints out;
        out.head = names.head.empty() ? find_named(Side::none, kHead) : exact(names.head);
        if (out.head < 0) out.head = deepest("neck");
        if (out.head < 0) missing_.emplace_back("head");
        out.left = find_arm(Side::left, names.left, "left");
        out.right = find_arm(Side::right, names.right, "right");
        LegJoints const left = find_leg(Side::left, names.left_leg, "left"),
                        right = find_leg(Side::right, names.right_leg, "right");
        if (left.foot >= 0 && right.foot >= 0) {
            out.left_leg = left;
            out.right_leg = right;
        }
        return out;
    }
    std::vector<std::string> const& missing() const { return missing_; }

private:
    Node const& node(std::int32_t i) const { return scene_.nodes[std::size_t(i)]; }

    std::int32_t find_named(Side side, std::vector<std::string> const& parts) const
    {
        for (std::string const& part : parts)
            for (std::size_t i = 0; i < joints_.size(); ++i)
                if (names_[i].side == side && names_[i].part == part) return joints_[i];
        return -1;
    }
    std::int32_t find_below(std::int32_t ancestor, Side side, std::vector<std::string> const& parts) const
    {
        for (std::string const& part : parts)
            for (std::size_t i = 0; i < joints_.size() && ancestor >= 0; ++i)
                if (names_[i].side == side && names_[i].part == part && below(joints_[i], ancestor))
                    return joints_[i];
        return -1;
    }
    std::int32_t deepest(std::string const& part) const
    {
        for (std::size_t i = joints_.size(); i > 0; --i)
            if (names_[i - 1].part == part) return joints_[i - 1];
        return -1;
    }
    /// Returns a joint of that name, or else any node of that name.
    std::int32_t exact(std::string const& name) const
    {
        for (std::int32_t const j : joints_)
            if (node(j).name == name) return j;
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i)
            if (scene_.nodes[i].name == name) return std::int32_t(i);
        throw InputError("there is no joint '" + name.substr(0, 64) + "'", "the avatar needs it",
                         "check the name");
    }
    std::int32_t only_joint_below(std::int32_t parent) const
    {
        std::int32_t found = -1;
        for (std::int32_t const j : joints_) {
            if (parent < 0 || node(j).parent != parent) continue;
            if (found >= 0) return -1;
            found = j;
        }
        return found;
    }
    bool below(std::int32_t child, std::int32_t ancestor) const
    {
        for (std::int32_t n = child; n >= 0; n = node(n).parent)
            if (n == ancestor) return n != child;
        return false;
    }

    ArmJoints find_arm(Side side, ArmNames const& names, std::string const& which)
    {
        ArmJoints arm;
        arm.upper = names.upper.empty() ? find_named(side, kUpper) : exact(names.upper);
        arm.lower = names.lower.empty() ? find_named(side, kLower) : exact(names.lower);
        if (arm.lower < 0) arm.lower = only_joint_below(arm.upper);
        arm.hand = names.hand.empty() ? find_named(side, kHand) : exact(names.hand);
        if (arm.hand < 0) arm.hand = only_joint_below(arm.lower);
        if (arm.upper < 0) missing_.push_back(which + " upper arm");
        if (arm.lower < 0) missing_.push_back(which + " lower arm");
        if (arm.hand < 0) missing_.push_back(which + " hand");
        for (auto const& [child, parent] : {std::pair{arm.lower, arm.upper}, {arm.hand, arm.lower}})
            if (child >= 0 && parent >= 0 && !below(child, parent))
                throw InputError(fmt::format("joint '{}' is not below '{}'", node(child).name, node(parent).name),
                                 fmt::format("they form no {} arm", which), "name upper arm, lower arm and hand");
        return arm;
    }

    /// Returns all -1 if one of the joints is not found.
    LegJoints find_leg(Side side, LegNames const& names, std::string const& which) const
    {
        LegJoints leg;
        leg.upper = names.upper.empty() ? find_named(side, kThigh) : exact(names.upper);
        leg.lower = names.lower.empty() ? find_below(leg.upper, side, kShin) : exact(names.lower);
        if (leg.lower < 0) leg.lower = only_joint_below(leg.upper);
        leg.foot = names.foot.empty() ? find_below(leg.lower, side, kFoot) : exact(names.foot);
        if (leg.foot < 0) leg.foot = find_named(side, kFoot);
        if (leg.foot < 0) leg.foot = only_joint_below(leg.lower);
        bool const is_chain = leg.upper >= 0 && leg.lower >= 0 && below(leg.lower, leg.upper) && leg.foot >= 0 &&
                              leg.foot != leg.lower && !below(leg.upper, leg.foot) && !below(leg.lower, leg.foot);
        if (is_chain) return leg;
        if (!names.upper.empty() || !names.lower.empty() || !names.foot.empty())
            throw InputError(
                fmt::format("'{}', '{}' and '{}' form no {} leg", names.upper, names.lower, names.foot, which),
                "the shin must be below the thigh and neither below the foot", "name thigh, shin and foot");
        return {};
    }

    Scene const& scene_;
    std::vector<std::int32_t> joints_;
    std::vector<JointName> names_;
    std::vector<std::string> missing_;
};

} // namespace

int joint_side(std::string const& name)
{
    Side const side = parse_name(name).side;
    return side == Side::left ? 1 : side == Side::right ? -1 : 0;
}

AvatarJoints find_avatar_joints(Scene const& scene, AvatarNames const& names, std::int32_t skin)
{
    if (scene.skins.empty())
        throw InputError("'" + scene.name + "' has no skeleton", "there are no joints to move",
                         "give a skinned avatar");
    std::vector<std::string> missing;
    for (std::size_t s = 0; s < scene.skins.size(); ++s) {
        if (skin >= 0 && std::size_t(skin) != s) continue;
        Finder finder(scene, scene.skins[s].joints);
        AvatarJoints const joints = finder.find(names);
        if (finder.missing().empty()) return joints;
        if (missing.empty() || finder.missing().size() < missing.size()) missing = finder.missing();
    }
    std::string known;
    for (std::size_t s = 0; s < scene.skins.size(); ++s)
        for (std::int32_t const j : scene.skins[s].joints)
            if (known.size() < 2000) known += (known.empty() ? "" : ", ") + scene.nodes[std::size_t(j)].name;
    throw InputError(fmt::format("the avatar has no {}", fmt::join(missing, ", ")), "no joint has a known name",
                     "name them in a joint map (lightwell avatar map proposes one); existing joints: " + known);
}

} // namespace gi
