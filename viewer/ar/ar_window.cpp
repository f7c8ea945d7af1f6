#include "viewer/ar/ar_window.h"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

constexpr std::size_t kShownLatencies = 120;

double now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

WindowSettings window_settings(ArWindowSettings const& s)
{
    WindowSettings w;
    w.title = "Lightwell: augmented reality";
    w.size_px = s.size_px;
    w.monitor = s.monitor;
    w.swap_interval = s.swap_interval;
    w.visibility = s.visibility;
    return w;
}

/// Left half before, right half after.
cv::Mat split(cv::Mat const& before, cv::Mat const& after)
{
    cv::Mat both = after.clone();
    cv::Rect const left(0, 0, after.cols / 2, after.rows);
    before(left).copyTo(both(left));
    cv::line(both, {left.width, 0}, {left.width, after.rows}, cv::Scalar::all(255));
    return both;
}

} // namespace

ArWindow::ArWindow(ArWindowSettings const& settings, gi::Report& report)
    : window_(window_settings(settings), report),
      panel_(window_),
      texture_(GlObject::Kind::texture, GL_TEXTURE_2D),
      framebuffer_(GlObject::Kind::framebuffer)
{
}

void ArWindow::take_input()
{
    poll_windows();
    std::vector<InputEvent> events = window_.take_events();
    panel_.claim(events);
    for (InputEvent const& e : events) {
        if (e.kind == InputKind::close) wants_close_ = true;
        if (e.kind != InputKind::key || e.action != InputAction::press || e.meant_for == InputFor::panel) continue;
        if (e.code == GLFW_KEY_ESCAPE) wants_close_ = true;
        if (e.code == GLFW_KEY_S) is_split_ = !is_split_;
        if (e.code == GLFW_KEY_H) has_panel_ = !has_panel_;
    }
}

void ArWindow::fill_panel(ArFrameRecord const& f)
{
    panel_.begin();
    if (has_panel_) {
        ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
        ImGui::Begin("session", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
        ImGui::Text("frame %llu; camera found in %.1f %%", static_cast<unsigned long long>(f.sequence),
                    100.0 * double(frames_ - lost_) / double(frames_));
        if (f.world_from_camera) {
            glm::dvec3 const p = f.world_from_camera->position_m;
            ImGui::Text("at %.3f %.3f %.3f m, %d points, %d left out", p.x, p.y, p.z, f.points_used,
                        f.points_rejected);
            ImGui::Text("residual %.2f px, confidence %.2f", f.rms_px, f.confidence);
        } else {
            ImGui::TextUnformatted("no camera: markers out of view?");
        }
        ImGui::Text("decode %.1f  detect %.1f  pose %.1f  render %.1f  composite %.1f ms", f.times.decode_ms,
                    f.times.detect_ms, f.times.pose_ms, f.times.render_ms, f.times.composite_ms);
        if (!latency_ms_.empty()) {
            ImGui::Text("capture to swap %.1f ms", double(latency_ms_.back()));
            ImGui::PlotLines("ms", latency_ms_.data(), int(latency_ms_.size()), 0, nullptr, 0, FLT_MAX, {200, 40});
        }
        if (f.exposure.time_s > 0)
            ImGui::Text("exposure %.2f ms, gain %.2f", 1e3 * f.exposure.time_s, f.exposure.gain);
        ImGui::Text("changed %.1f %%, clipped %zu, not finite %zu px",
                    100.0 * double(f.counts.pixels - f.counts.copied) /
                        double(std::max<std::size_t>(1, f.counts.pixels)),
                    f.counts.clipped, f.counts.not_finite);
        ImGui::TextUnformatted("S before and after   H panel   Esc end");
        ImGui::End();
    }
    panel_.finish();
}

void ArWindow::draw(cv::Mat const& rgb)
{
    glm::ivec2 const window_px = window_.framebuffer_px();
    glBindTexture(GL_TEXTURE_2D, texture_.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, int(rgb.step / 3));
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, rgb.cols, rgb.rows, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.id(), 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    // As large as fits, in the middle; the top row of a texture comes first, of a window last.
    double const scale = std::min(double(window_px.x) / rgb.cols, double(window_px.y) / rgb.rows);
    glm::ivec2 const size(int(std::lround(scale * rgb.cols)), int(std::lround(scale * rgb.rows)));
    glm::ivec2 const corner = (window_px - size) / 2;
    glBlitFramebuffer(0, 0, rgb.cols, rgb.rows, corner.x, corner.y + size.y, corner.x + size.x, corner.y,
                      GL_COLOR_BUFFER_BIT, size.x == rgb.cols && size.y == rgb.rows ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void ArWindow::show(ArFrameRecord& record, ArResult const& result)
{
    double const begun_s = now_s();
    take_input();
    ++frames_;
    if (!record.world_from_camera) ++lost_;
    cv::Mat const shown = is_split_ ? split(result.camera, result.rgb) : result.rgb;
    fill_panel(record);
    draw(shown);
    panel_.draw();
    window_.swap();
    glFinish();
    record.present_ms = 1e3 * (now_s() - begun_s);
    if (!record.captured_steady_s) return;
    record.swapped_ms = 1e3 * (now_s() - *record.captured_steady_s);
    if (latency_ms_.size() == kShownLatencies) latency_ms_.erase(latency_ms_.begin());
    latency_ms_.push_back(float(record.swapped_ms));
}

} // namespace viewer
