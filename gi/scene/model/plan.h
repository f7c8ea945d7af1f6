#pragma once
// The scene plan: what is built for this scene and what is left out, each with its reason; `lightwell info` prints
// it. Tables (lights, sky, normals) are built where the world has what they hold; alpha tests where the plan says
// so.

#include "gi/scene/model/world.h"

#include <string>
#include <vector>

namespace gi {

struct PlanItem {
    std::string what; ///< "environment sampling", "alpha tests", "delta lobes", ...
    bool build = false;
    std::string reason; ///< "3 of 25 materials are masks", "no light-transmitting material"
};

struct ScenePlan {
    bool alpha_tests = false; ///< some material is a mask or blends: rays must ask for coverage
    bool environment = false;
    bool emitters = false;
    bool punctual_lights = false;
    bool delta_lobes = false; ///< mirrors or smooth glass
    bool transmission = false;
    bool textures = false, normal_maps = false;
    bool skins = false, morphs = false, motion = false; ///< motion: some clip plays
    bool moving_parts = false; ///< some triangles can move: what holds them is renewed with time, the rest is not
    std::vector<PlanItem> items;
};

ScenePlan plan_scene(World const& world);

} // namespace gi
