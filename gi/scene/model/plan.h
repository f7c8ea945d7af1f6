#pragma once
// The scene plan: what is built for this scene and what is not, each with its reason; printed by `lightwell info`.
// Tables (lights, sky, normals) are built if the world has the data for them, alpha tests if the plan says so.

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
    bool alpha_tests = false; ///< some material is a mask or blends: rays must evaluate coverage
    bool environment = false;
    bool emitters = false;
    bool punctual_lights = false;
    bool delta_lobes = false; ///< mirrors or smooth glass
    bool transmission = false;
    bool textures = false, normal_maps = false;
    bool skins = false, morphs = false, motion = false; ///< motion: at least one clip plays
    bool moving_parts = false; ///< some triangles can move; only what contains them is updated over time
    std::vector<PlanItem> items;
};

ScenePlan plan_scene(World const& world);

} // namespace gi
