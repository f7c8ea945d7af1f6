#include "viewer/cli/ar/ar_truth_json.h"

namespace viewer {

nlohmann::ordered_json to_json(ar::FrameErrors const& e)
{
    auto const spread = [](std::vector<double> const& values) -> nlohmann::ordered_json {
        if (values.empty()) return nullptr;
        ar::Spread const s = ar::spread_of(values);
        return {{"median", s.median}, {"p95", s.p95}, {"most", s.most}};
    };
    return {{"position_mm", spread(e.position_mm)},
            {"rotation_deg", spread(e.rotation_deg)},
            {"flip_affected", spread(e.flip_affected)},
            {"flip_affected_of_adding_nothing", spread(e.camera_affected)},
            {"affected_percent", spread(e.affected_percent)},
            {"flip_elsewhere", spread(e.flip_elsewhere)},
            {"flip_elsewhere_of_adding_nothing", spread(e.camera_elsewhere)},
            {"frames_compared", e.compared()},
            {"frames_unaffected", e.unaffected},
            {"frames_equal_to_the_camera", e.equal},
            {"frames_without_picture", e.without_picture},
            {"pictures_unusable", e.unusable},
            {"frames_without_true_pose", e.without_pose}};
}

} // namespace viewer
