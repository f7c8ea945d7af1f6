#pragma once
#include "gi/scene/model/plan.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// A list with the name, what, build, reason and numbers of each item, as common.schema.json says.
nlohmann::ordered_json to_json(std::vector<gi::PlanItem> const& plan);

} // namespace viewer
