#include "viewer/offline/plan_json.h"

namespace viewer {

nlohmann::ordered_json to_json(std::vector<gi::PlanItem> const& plan)
{
    auto list = nlohmann::ordered_json::array();
    for (gi::PlanItem const& item : plan) {
        auto numbers = nlohmann::ordered_json::object();
        for (gi::PlanNumber const& n : item.numbers)
            std::visit([&](auto value) { numbers[n.key] = value; }, n.value);
        list.push_back({{"name", item.name},
                        {"what", item.what},
                        {"build", item.build},
                        {"reason", item.reason},
                        {"numbers", numbers}});
    }
    return list;
}

} // namespace viewer
