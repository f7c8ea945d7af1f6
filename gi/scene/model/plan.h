#pragma once
// The scene plan: what is built for this scene and what is not, each with its reason; printed by `lightwell info`.
// Tables (lights, sky, normals) are built if the world has the data for them, alpha tests if the plan says so.

#include "gi/scene/model/plan_text.h"
#include "gi/scene/model/world.h"

#include <string>
#include <vector>

namespace gi {

struct PlanItem {
    std::string name; ///< for programs; does not change: "alpha_tests"
    std::string what; ///< "environment sampling", "alpha tests", "delta lobes", ...
    bool build = false;
    std::string reason;              ///< "3 of 25 materials are masks", "no light-transmitting material"
    std::vector<PlanNumber> numbers; ///< in `what` and `reason`; each key once

    PlanItem() = default;
    PlanItem(std::string called, PlanText const& words, bool is_built, PlanText const& why)
        : name(std::move(called)),
          what(words.text),
          build(is_built),
          reason(why.text),
          numbers((words + why).numbers)
    {
    }
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
