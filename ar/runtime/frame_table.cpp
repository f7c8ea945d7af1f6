#include "ar/runtime/runner.h"

#include <fmt/format.h>

namespace ar {

std::string frame_table(RunSummary const& summary)
{
    std::string text =
        "sequence,captured_s,overtaken,read_ms,age_ms,decode_ms,detect_ms,pose_ms,wait_ms,light_ms,render_ms,"
        "composite_ms,latency_ms,show_wait_ms,present_ms,swapped_ms,"
        "markers,points_used,points_rejected,rms_px,confidence,x_m,y_m,z_m,qx,qy,qz,qw,changed_px,clipped_px,"
        "negative_values,not_finite_px,state,shown,"
        "markers_unknown,markers_ambiguous,boards_left_out,lost_by,expected_error_mm,distance_m\n";
    for (RunFrame const& f : summary.frames) {
        text += fmt::format("{},{:.6f},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},", f.sequence, f.captured_s,
                            f.overtaken, f.read_ms, f.age_ms, f.times.decode_ms, f.times.detect_ms,
                            f.times.pose_ms, f.times.wait_ms);
        text += fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{:.4f},{:.4f},",
                            f.times.light_ms, f.times.render_ms, f.times.composite_ms, f.latency_ms,
                            f.show_wait_ms, f.present_ms, f.swapped_ms, f.markers, f.points_used,
                            f.points_rejected, f.rms_px, f.confidence);
        if (f.world_from_camera) {
            gi::RigidPose const& p = *f.world_from_camera;
            text += fmt::format("{:.7f},{:.7f},{:.7f},{:.8f},{:.8f},{:.8f},{:.8f},", p.position.x, p.position.y,
                                p.position.z, p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w);
        } else {
            text += ",,,,,,,";
        }
        text += fmt::format("{},{},{},{},{},{:.3f},{},{},{},{},{},{}\n", f.counts.pixels - f.counts.copied,
                            f.counts.clipped, f.counts.negative, f.counts.not_finite, name_of(f.state), f.shown,
                            f.markers_unknown, f.markers_ambiguous, f.boards_left_out, f.lost_by,
                            f.expected_error_m ? fmt::format("{:.3f}", 1e3 * *f.expected_error_m) : "",
                            f.distance_m > 0 ? fmt::format("{:.5f}", f.distance_m) : "");
    }
    return text;
}

} // namespace ar
