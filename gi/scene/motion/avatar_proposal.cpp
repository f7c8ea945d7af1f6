#include "gi/scene/motion/avatar_proposal.h"

#include "gi/core/error.h"
#include "gi/scene/motion/animation.h"
#include "gi/scene/motion/avatar_map.h"
#include "gi/scene/motion/joint_motion.h"
#include "gi/scene/motion/skinning.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace gi {
namespace {

constexpr double kByName = 0.95;
constexpr double kMovesSomething = 0.002; ///< share of all skin weights; end joints have none
constexpr double kUnequalBones = 3;       ///< weight of the difference of two bones against their sum
constexpr double kFeetAhead = 0.015;      ///< of both feet's middles before their ankles, in body heights
constexpr double kLevelBone = 0.7;        ///< a bone with less of its length downwards is level

using Chain = std::vector<std::int32_t>; ///< from the trunk outwards

/// A chain and its mirror image.
struct Pair {
    Chain a, b;
    std::int32_t from = -1; ///< where both branch off
    double length_m = 0, asymmetry = 0;
    double end_y = 0, start_y = 0; ///< heights above the lowest joint, in body heights
};

class Skeleton {
public:
    Skeleton(Scene const& scene, Pose const& rest, std::size_t skin)
        : scene_(scene),
          rest_(rest),
          weight_(scene.nodes.size(), 0.0),
          children_(scene.nodes.size()),
          is_joint_(scene.nodes.size(), false)
    {
        for (std::int32_t const j : scene.skins[skin].joints) is_joint_[std::size_t(j)] = true;
        joints_ = scene.skins[skin].joints;
        std::sort(joints_.begin(), joints_.end());
        joints_.erase(std::unique(joints_.begin(), joints_.end()), joints_.end());
        for (std::int32_t const j : joints_)
            if (std::int32_t const p = parent(j); p >= 0) children_[std::size_t(p)].push_back(j);
        add_weights();
        lowest_ = std::numeric_limits<double>::max();
        double highest = -lowest_;
        for (std::int32_t const j : joints_) {
            lowest_ = std::min(lowest_, at(j).y);
            highest = std::max(highest, at(j).y);
        }
        height_ = highest - lowest_;
    }

    double height_m() const { return height_; }
    Chain const& joints() const { return joints_; }
    dvec3 at(std::int32_t j) const { return joint_position(rest_, j); }
    double height_of(std::int32_t j) const { return (at(j).y - lowest_) / height_; }
    Chain const& children(std::int32_t j) const { return children_[std::size_t(j)]; }
    /// The nearest joint above.
    std::int32_t parent(std::int32_t j) const
    {
        std::int32_t p = scene_.nodes[std::size_t(j)].parent;
        while (p >= 0 && !is_joint_[std::size_t(p)]) p = scene_.nodes[std::size_t(p)].parent;
        return p;
    }
    bool below(std::int32_t j, std::int32_t ancestor) const
    {
        for (; j >= 0; j = parent(j))
            if (j == ancestor) return true;
        return false;
    }
    /// Share of all skin weights that this joint and those below it have.
    double weight_below(std::int32_t top) const
    {
        double sum = 0;
        for (std::int32_t const j : joints_)
            if (below(j, top)) sum += weight_[std::size_t(j)];
        return sum;
    }
    double weight(std::int32_t j) const { return weight_[std::size_t(j)]; }

    /// The longest way (m) from a joint outwards over joints that move something.
    Chain longest(std::int32_t from) const
    {
        Chain best{from};
        double best_m = 0;
        for (std::int32_t const c : children(from)) {
            if (weight_below(c) < kMovesSomething) continue;
            Chain way = longest(c);
            double const m = glm::distance(at(from), at(c)) + length_m(way);
            if (m <= best_m) continue;
            best_m = m;
            best = {from};
            best.insert(best.end(), way.begin(), way.end());
        }
        return best;
    }
    /// Chains of two and more joints that begin at a joint: fingers, but not the twist joints of an arm.
    int branches(std::int32_t from) const
    {
        return int(std::count_if(children(from).begin(), children(from).end(),
                                 [this](std::int32_t c) { return longest(c).size() >= 2; }));
    }
    /// Where the vertices of a joint and those below it are on average, seen from the joint, level, m.
    dvec3 level_mean(std::int32_t top) const
    {
        dvec3 sum{0};
        double all = 0;
        for (std::size_t n = 0; n < scene_.nodes.size(); ++n) {
            if (scene_.nodes[n].skin < 0) continue;
            Chain const& of = scene_.skins[std::size_t(scene_.nodes[n].skin)].joints;
            std::vector<bool> counts(of.size());
            for (std::size_t j = 0; j < of.size(); ++j) counts[j] = below(of[j], top);
            for (std::int32_t const m : scene_.nodes[n].meshes) {
                Mesh const& mesh = scene_.meshes[std::size_t(m)];
                if (mesh.joints.empty()) continue;
                std::vector<vec3> const at = deform(scene_, rest_, n, mesh).positions;
                for (std::size_t v = 0; v < at.size(); ++v)
                    for (int k = 0; k < 4; ++k) {
                        std::size_t const j = mesh.joints[v][std::size_t(k)];
                        if (j >= of.size() || !counts[j]) continue;
                        sum += double(mesh.weights[v][k]) * (dvec3(at[v]) - this->at(top));
                        all += double(mesh.weights[v][k]);
                    }
            }
        }
        return all > 0 ? dvec3{sum.x / all, 0, sum.z / all} : dvec3{0};
    }
    double length_m(Chain const& c) const
    {
        double m = 0;
        for (std::size_t k = 1; k < c.size(); ++k) m += glm::distance(at(c[k - 1]), at(c[k]));
        return m;
    }

private:
    void add_weights()
    {
        double all = 0;
        for (Node const& n : scene_.nodes) {
            if (n.skin < 0) continue;
            Chain const& of = scene_.skins[std::size_t(n.skin)].joints;
            for (std::int32_t const m : n.meshes) {
                Mesh const& mesh = scene_.meshes[std::size_t(m)];
                for (std::size_t v = 0; v < mesh.joints.size(); ++v)
                    for (int k = 0; k < 4; ++k) {
                        std::size_t const j = mesh.joints[v][std::size_t(k)];
                        if (j >= of.size()) continue;
                        weight_[std::size_t(of[j])] += double(mesh.weights[v][k]);
                        all += double(mesh.weights[v][k]);
                    }
            }
        }
        // A skeleton without a mesh: all joints count alike.
        for (std::int32_t const j : joints_) {
            double& w = weight_[std::size_t(j)];
            w = all > 0 ? w / all : 1.0 / double(joints_.size());
        }
    }

    Scene const& scene_;
    Pose const& rest_;
    std::vector<double> weight_;
    std::vector<Chain> children_;
    std::vector<bool> is_joint_;
    Chain joints_;
    double lowest_ = 0, height_ = 0;
};

/// All pairs of chains that mirror each other, from joints where they branch off.
std::vector<Pair> mirrored_pairs(Skeleton const& s)
{
    std::vector<Pair> pairs;
    for (std::int32_t const from : s.joints()) {
        Chain const& c = s.children(from);
        for (std::size_t i = 0; i < c.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                Pair p{s.longest(c[k]), s.longest(c[i]), from};
                double const a = s.length_m(p.a) + glm::distance(s.at(from), s.at(c[k])),
                             b = s.length_m(p.b) + glm::distance(s.at(from), s.at(c[i]));
                p.length_m = 0.5 * (a + b);
                dvec3 const end_a = s.at(p.a.back()), end_b = s.at(p.b.back());
                double const apart = std::hypot(end_a.x - end_b.x, end_a.z - end_b.z);
                if (p.a.size() < 3 || p.b.size() < 3 || p.length_m < 0.15 * s.height_m()) continue;
                if (apart < 0.03 * s.height_m()) continue;
                p.asymmetry = std::abs(a - b) / p.length_m + std::abs(end_a.y - end_b.y) / s.height_m();
                if (p.asymmetry > 0.35) continue;
                p.end_y = std::min(s.height_of(p.a.back()), s.height_of(p.b.back()));
                p.start_y = 0.5 * (s.height_of(p.a.front()) + s.height_of(p.b.front()));
                pairs.push_back(std::move(p));
            }
    }
    return pairs;
}

struct Three {
    std::int32_t upper = -1, lower = -1, end = -1;
};

/// The joints i < j < k of a chain with the longest bones of the most equal length; k at most at `last`.
Three two_bones(Skeleton const& s, Chain const& chain, std::size_t last)
{
    Three best;
    double most = -std::numeric_limits<double>::max();
    for (std::size_t k = 2; k <= last; ++k)
        for (std::size_t j = 1; j < k; ++j)
            for (std::size_t i = 0; i < j; ++i) {
                double const a = glm::distance(s.at(chain[i]), s.at(chain[j])),
                             b = glm::distance(s.at(chain[j]), s.at(chain[k]));
                double const score = a + b - kUnequalBones * std::abs(a - b);
                if (score <= most) continue;
                most = score;
                best = {chain[i], chain[j], chain[k]};
            }
    return best;
}

/// The wrist is where fingers branch off, if they do.
Three arm_of(Skeleton const& s, Chain const& chain)
{
    std::size_t last = chain.size() - 1;
    for (std::size_t k = 2; k < last; ++k)
        if (s.branches(chain[k]) >= 2) last = k;
    return two_bones(s, chain, last);
}

/// The ankle is the last joint before the leg turns level.
Three leg_of(Skeleton const& s, Chain const& chain)
{
    std::size_t last = chain.size() - 1;
    while (last > 2) {
        dvec3 const bone = s.at(chain[last]) - s.at(chain[last - 1]);
        if (-bone.y > kLevelBone * glm::length(bone) && glm::length(bone) > 0.08 * s.height_m()) break;
        --last;
    }
    return two_bones(s, chain, last);
}

/// Joint that turns the head, on the chain above the place where the arms branch off; -1 = none.
std::int32_t head_of(Skeleton const& s, std::int32_t chest, Pair const& arms)
{
    std::int32_t top = -1;
    for (std::int32_t const j : s.joints()) {
        bool const in_arm = s.below(j, arms.a.front()) || s.below(j, arms.b.front());
        if (j == chest || in_arm || !s.below(j, chest) || s.weight_below(j) < kMovesSomething) continue;
        if (top < 0 || s.at(j).y > s.at(top).y) top = j;
    }
    if (top < 0 || s.at(top).y < s.at(chest).y) return -1;
    Chain up;
    for (std::int32_t j = top; j >= 0 && j != chest; j = s.parent(j)) up.insert(up.begin(), j);
    double const all = s.weight_below(up.front());
    std::int32_t head = up.front();
    for (std::int32_t const j : up)
        if (s.weight_below(j) >= 0.5 * all) head = j;
    return head;
}

/// +1 if `a` is on the avatar's left. @param forward  level, not 0
bool is_left(dvec3 a, dvec3 b, dvec3 forward)
{
    dvec3 const left = glm::cross(dvec3{0, 1, 0}, forward);
    return glm::dot(a - b, left) > 0;
}

/// By the words "left", "L", ... in the names of a chain: +1 left, -1 right, 0 unknown.
int side_by_name(Scene const& scene, Chain const& chain)
{
    int sum = 0;
    for (std::int32_t const j : chain) sum += joint_side(scene.nodes[std::size_t(j)].name);
    return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

std::optional<AvatarProposal> propose(Scene const& scene, Pose const& rest, std::size_t skin)
{
    Skeleton const s(scene, rest, skin);
    if (!(s.height_m() > 0)) return {};
    std::vector<Pair> const pairs = mirrored_pairs(s);
    Pair const* legs = nullptr;
    for (Pair const& p : pairs)
        if (p.end_y < 0.2 && p.start_y > 0.25 && p.start_y < 0.75 && (!legs || p.length_m > legs->length_m))
            legs = &p;
    Pair const* arms = nullptr;
    std::int32_t head = -1;
    for (Pair const& p : pairs) {
        bool const in_leg = legs && (s.below(p.from, legs->a.front()) || s.below(p.from, legs->b.front()));
        if (&p == legs || in_leg || p.start_y < 0.5 || (arms && arms->length_m >= p.length_m)) continue;
        std::int32_t const above = head_of(s, p.from, p);
        if (above < 0) continue; // ears, hair or wings above the head's joint
        arms = &p;
        head = above;
    }
    if (!arms) return {};
    AvatarProposal out;
    out.joints.head = head;
    out.head = {std::clamp(0.4 + 0.5 * s.height_of(head), 0.0, 0.9),
                fmt::format("moves most of what is above '{}', where the arms branch off",
                            node_reference(scene, arms->from))};
    Three a = arm_of(s, arms->a), b = arm_of(s, arms->b);
    out.arms = {
        std::clamp(0.9 - arms->asymmetry, 0.1, 0.9),
        fmt::format("the longest two chains that mirror each other above the hips ({:.2f} m, asymmetry {:.0f} %)",
                    arms->length_m, 100 * arms->asymmetry)};
    Three leg_a, leg_b;
    if (legs) {
        leg_a = leg_of(s, legs->a);
        leg_b = leg_of(s, legs->b);
        out.legs = {
            std::clamp(0.9 - legs->asymmetry, 0.1, 0.9),
            fmt::format("the longest two chains that mirror each other down to the floor ({:.2f} m, asymmetry "
                        "{:.0f} %)",
                        legs->length_m, 100 * legs->asymmetry)};
    } else {
        out.legs = {0, "no two chains that mirror each other reach the floor: the avatar has no legs that step"};
    }
    int const by_name = side_by_name(scene, arms->a) - side_by_name(scene, arms->b);
    dvec3 forward{0, 0, 1};
    bool by_toes = false;
    if (legs) {
        dvec3 toes{0};
        for (auto const& [chain, leg] : {std::pair{&legs->a, &leg_a}, {&legs->b, &leg_b}})
            toes += s.at(chain->back()) - s.at(leg->end) + s.level_mean(leg->end);
        toes.y = 0;
        by_toes = glm::length(toes) > kFeetAhead * s.height_m();
        if (by_toes) forward = glm::normalize(toes);
    }
    bool a_is_left = is_left(s.at(a.upper), s.at(b.upper), forward);
    if (by_name != 0) {
        a_is_left = by_name > 0;
        out.sides = {kByName, "by the sides in the names"};
    } else {
        out.sides =
            by_toes ? ProposedPart{0.8, "the toes point forward"}
                    : ProposedPart{0.5, "nothing tells the front, taken to be +Z: check that left and right are "
                                        "the avatar's own"};
    }
    if (!a_is_left) std::swap(a, b);
    out.joints.left = {a.upper, a.lower, a.end};
    out.joints.right = {b.upper, b.lower, b.end};
    if (legs) {
        dvec3 const across = s.at(a.upper) - s.at(b.upper);
        if (glm::dot(s.at(leg_a.upper) - s.at(leg_b.upper), across) < 0) std::swap(leg_a, leg_b);
        out.joints.left_leg = {leg_a.upper, leg_a.lower, leg_a.end};
        out.joints.right_leg = {leg_b.upper, leg_b.lower, leg_b.end};
    }
    return out;
}

} // namespace

AvatarProposal propose_avatar_joints(Scene const& scene)
{
    if (scene.skins.empty())
        throw InputError("'" + scene.name + "' has no skeleton", "there are no joints to move",
                         "give a skinned model");
    std::optional<AvatarProposal> named;
    try {
        ProposedPart const usual{kByName, "by the names of a usual rig"};
        named = AvatarProposal{find_avatar_joints(scene), usual, usual, usual, usual};
        if (named->joints.left_leg.foot >= 0) return *named;
    } catch (InputError const&) { // then by the shape
    }
    Pose const rest = evaluate_pose(scene, std::nullopt);
    std::optional<AvatarProposal> best;
    for (std::size_t skin = 0; skin < scene.skins.size(); ++skin)
        if (auto found = propose(scene, rest, skin))
            if (!best || found->arms.confidence > best->arms.confidence) best = std::move(found);
    if (named) { // all but the legs
        named->legs = best ? best->legs : ProposedPart{0, "no joint has a usual name"};
        if (best) named->joints.left_leg = best->joints.left_leg, named->joints.right_leg = best->joints.right_leg;
        return *named;
    }
    if (!best)
        throw InputError("no avatar can be made of '" + scene.name + "'",
                         "its skeleton has no two long chains that mirror each other below a head",
                         "name the joints in a file by hand (docs/viewer.md#avatars)");
    return *best;
}

std::string to_avatar_map(Scene const& scene, AvatarProposal const& p, std::string const& model)
{
    auto const name = [&scene](std::int32_t node) {
        std::string quoted = "\"";
        for (char const c : node_reference(scene, node))
            quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
        return quoted + "\"";
    };
    auto const because = [](ProposedPart const& part) {
        return fmt::format("# confidence {:.2f}: {}\n", part.confidence, part.reason);
    };
    auto const limb = [&](char const* key, std::int32_t upper, std::int32_t lower, char const* last,
                          std::int32_t end) {
        return fmt::format("{}: {{upper: {}, lower: {}, {}: {}}}\n", key, name(upper), name(lower), last,
                           name(end));
    };
    std::string text = "# Joints of " + model + ", proposed by lightwell avatar map. Left is the avatar's own.\n";
    AvatarJoints const& j = p.joints;
    text += because(p.head) + "head: " + name(j.head) + "\n";
    text += because(p.arms) + "# left and right, " + because(p.sides).substr(2);
    text += limb("left_arm", j.left.upper, j.left.lower, "hand", j.left.hand);
    text += limb("right_arm", j.right.upper, j.right.lower, "hand", j.right.hand);
    text += because(p.legs);
    if (j.left_leg.foot >= 0) {
        text += limb("left_leg", j.left_leg.upper, j.left_leg.lower, "foot", j.left_leg.foot);
        text += limb("right_leg", j.right_leg.upper, j.right_leg.lower, "foot", j.right_leg.foot);
    }
    return text;
}

} // namespace gi
