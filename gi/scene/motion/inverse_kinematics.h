#pragma once
// Two-bone inverse kinematics (shoulder-elbow-wrist) in closed form: the law of cosines gives the middle joint's
// distance from the line root-target, the pole determines the side.

#include "gi/core/math.h"

namespace gi {

/// Resulting positions of a limb's joints, m.
struct TwoBones {
    dvec3 middle, end;
};

/// Returns the limb from `root` with bones of length upper_m and lower_m (>= 0) whose end is at `target`,
/// bent towards the direction `pole` (of any length; if it is zero or along the limb, the side is arbitrary).
/// All inputs must be finite. A target out of reach is approached: if it is farther than upper + lower,
/// the limb is straight towards it; if nearer than |upper - lower|, the limb is folded back
/// along it. For a target at the root and equal bones, the middle joint lies along the pole.
/// Bones keep their lengths, and reachable targets are reached to rounding (1e-12 of the limb). The middle
/// joint moves continuously with the target except where the line to the target passes the pole's direction;
/// near a straight limb it moves like the square root of the distance.
TwoBones reach(dvec3 root, double upper_m, double lower_m, dvec3 target, dvec3 pole);

/// Returns the shortest rotation from one direction to another; for a half turn, by way of `hint`. Directions need
/// not be unit; a zero direction gives the identity. Error: 1e-8 rad.
dquat turn_between(dvec3 from, dvec3 to, dvec3 hint);

} // namespace gi
