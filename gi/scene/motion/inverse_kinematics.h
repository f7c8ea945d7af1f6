#pragma once
// A limb of two bones (shoulder-elbow-wrist) whose end goes to a target, in closed form: the law of cosines gives
// the middle joint's distance from the line root-target, the pole says to which side it goes.

#include "gi/core/math.h"

namespace gi {

/// Where the joints of a limb come to lie, m.
struct TwoBones {
    dvec3 middle, end;
};

/// The limb from `root` with bones of upper_m and lower_m (>= 0) that brings its end to `target`, bent towards the
/// direction `pole` (of any length; where it is zero or along the limb, towards some side). All finite.
/// A target out of reach is approached: farther than upper + lower, the limb is straight towards it; nearer than
/// |upper - lower|, it is folded back along it. At the root itself, with equal bones, the middle lies along the
/// pole. Bones keep their lengths and reachable targets are reached to rounding (1e-12 of the limb). The middle
/// moves continuously with the target but where the line to it passes the pole's; near a straight limb like the
/// square root of the distance.
TwoBones reach(dvec3 root, double upper_m, double lower_m, dvec3 target, dvec3 pole);

/// The shortest turn of one direction into another; of half a turn, by way of `hint`. Directions need not be unit;
/// a zero one gives no turn. Error: 1e-8 rad.
dquat turn_between(dvec3 from, dvec3 to, dvec3 hint);

} // namespace gi
