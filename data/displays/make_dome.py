#!/usr/bin/env python3
"""Writes dome.yaml: a dome as five flat walls of a cube, each bent by a mesh to its place in a fisheye picture of 180
degrees (angular: distance from the middle is proportional to the angle from the zenith; the front is at the bottom).
Right for eyes in the middle of the dome; elsewhere as wrong as a sphere differs from the cube."""
import math
import os

R = 4.0  # m
CELLS = 16
WALLS = {  # lower left, lower right, upper left
    "front": ((-R, 0, -R), (R, 0, -R), (-R, R, -R)),
    "right": ((R, 0, -R), (R, 0, R), (R, R, -R)),
    "back": ((R, 0, R), (-R, 0, R), (R, R, R)),
    "left": ((-R, 0, R), (-R, 0, -R), (-R, R, R)),
    "zenith": ((-R, R, -R), (R, R, -R), (-R, R, R)),
}


def fisheye(p):
    level = math.hypot(p[0], p[2])
    if level == 0:
        return 0.5, 0.5
    radius = math.atan2(level, p[1]) / math.pi
    return 0.5 + radius * p[0] / level, 0.5 + radius * p[2] / level


def main():
    out = [
        "# A dome of 4 m radius with a fisheye projector, written by make_dome.py: five walls of a cube, each warped to its",
        "# place in the round picture. The origin is the centre of the dome, where the eyes are; the front is at -z.",
        "name: dome",
        "walls:",
    ]
    for name, (ll, lr, ul) in WALLS.items():
        rows = CELLS if name == "zenith" else CELLS // 2
        out.append(f"  - name: {name}")
        for key, p in (("lower_left_m", ll), ("lower_right_m", lr), ("upper_left_m", ul)):
            out.append(f"    {key}: [{p[0]:g}, {p[1]:g}, {p[2]:g}]")
        out += ["    window: fisheye", f"    render_px: [1024, {1024 * rows // CELLS}]", "    warp:",
                f"      columns: {CELLS + 1}", f"      rows: {rows + 1}", "      nodes:"]
        for j in range(rows + 1):
            for i in range(CELLS + 1):
                u, v = i / CELLS, j / rows
                p = [ll[k] + u * (lr[k] - ll[k]) + v * (ul[k] - ll[k]) for k in range(3)]
                x, y = fisheye(p)
                out.append(f"        - [{x:.6f}, {y:.6f}, {u:g}, {v:g}]")
    out += ["windows:", "  - {name: fisheye, size_px: [2048, 2048]}", "users:",
            "  - {name: audience, head_position_m: [0, 0, 0]}"]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "dome.yaml"), "w") as f:
        f.write("\n".join(out) + "\n")


main()
