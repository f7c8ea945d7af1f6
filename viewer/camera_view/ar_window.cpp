#include "viewer/camera_view/ar_window.h"

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
    w.title = "Lightwell: waits for the first frame";
    w.size_px = s.size_px;
    w.monitor = s.monitor;
    w.swap_interval = s.swap_interval;
    w.visibility = s.visibility;
    return w;
}

GlObject texture()
{
    GlObject t(GlObject::Kind::texture, GL_TEXTURE_2D);
    for (GLenum const filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTextureParameteri(t.id(), filter, GL_LINEAR);
    return t;
}

/// CV_8UC3; its top row comes first.
void fill(GlObject const& texture, cv::Mat const& rgb)
{
    glBindTexture(GL_TEXTURE_2D, texture.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, int(rgb.step / 3));
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, rgb.cols, rgb.rows, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

/// Largest centred rectangle with the picture's aspect ratio.
cv::Rect place_of(glm::ivec2 picture_px, glm::ivec2 window_px)
{
    double const scale = std::min(double(window_px.x) / picture_px.x, double(window_px.y) / picture_px.y);
    int const width = int(std::lround(scale * picture_px.x)), height = int(std::lround(scale * picture_px.y));
    return {(window_px.x - width) / 2, (window_px.y - height) / 2, width, height};
}

} // namespace

ArWindow::ArWindow(ArWindowSettings const& settings, gi::Report& report)
    : settings_(settings),
      report_(report),
      window_(window_settings(settings), report),
      panel_(window_),
      picture_(texture()),
      camera_(texture()),
      light_texture_(texture()),
      framebuffer_(GlObject::Kind::framebuffer),
      has_panel_(settings.has_panel)
{
    if (settings.compositor != nullptr) pass_.emplace(*settings.compositor);
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

void ArWindow::fill_panel(ar::RunFrame const& f)
{
    panel_.begin();
    if (has_panel_) {
        ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
        ImGui::Begin("session", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
        ImGui::Text("frame %llu; camera found in %.1f %%", static_cast<unsigned long long>(f.sequence),
                    100.0 * double(frames_ - lost_) / double(frames_));
        if (f.world_from_camera) {
            glm::dvec3 const p = f.world_from_camera->position;
            ImGui::Text("at %.3f %.3f %.3f m, %d points, %d left out", p.x, p.y, p.z, f.points_used,
                        f.points_rejected);
            ImGui::Text("residual %.2f px, confidence %.2f", f.rms_px, f.confidence);
        } else if (f.state == ar::PoseState::uncertain) {
            ImGui::Text("pose not trusted: confidence %.2f", f.confidence);
        } else {
            ImGui::TextUnformatted("no camera: markers out of view?");
        }
        ImGui::Text("%s, objects shown to %.0f %%", ar::name_of(f.state).c_str(), 100 * f.shown);
        ImGui::Text("decode %.1f  detect %.1f  pose %.1f  render %.1f  composite %.1f ms", f.times.decode_ms,
                    f.times.detect_ms, f.times.pose_ms, f.times.render_ms, f.times.composite_ms);
        ImGui::Text("waited %.1f to be rendered, %.1f to be shown", f.times.wait_ms, f.show_wait_ms);
        if (!latency_ms_.empty()) {
            ImGui::Text("capture to swap %.1f ms", double(latency_ms_.back()));
            ImGui::PlotLines("ms", latency_ms_.data(), int(latency_ms_.size()), 0, nullptr, 0, FLT_MAX, {200, 40});
        }
        if (f.exposure.time_s > 0)
            ImGui::Text("exposure %.2f ms, gain %.2f", 1e3 * f.exposure.time_s, f.exposure.gain);
        if (f.counts.pixels > 0)
            ImGui::Text("changed %.1f %%, clipped %zu, not finite %zu px",
                        100.0 * double(f.counts.pixels - f.counts.copied) / double(f.counts.pixels),
                        f.counts.clipped, f.counts.not_finite);
        if (!light_.empty()) {
            ImGui::TextUnformatted("lit by");
            ImGui::Image(reinterpret_cast<ImTextureID>(std::uintptr_t(light_texture_.id())),
                         {float(light_.cols), float(light_.rows)});
        }
        ImGui::TextUnformatted("S before and after   H panel   Esc end");
        ImGui::End();
    }
    panel_.finish();
}

unsigned ArWindow::composite(ar::RunFrame const& record, ar::FrameResult const& result)
{
    if (!pass_ || !result.pair) {
        fill(picture_, ar::eight_bits_of(result.rgb));
        return picture_.id();
    }
    glm::ivec2 const size_px(result.camera.cols, result.camera.rows);
    if (!composited_ || composited_->shown().size_px != size_px)
        composited_.emplace(TextureTarget::Format::bytes, size_px);
    pass_->upload(ar::eight_bits_of(result.camera), *result.pair);
    pass_->draw(composited_->target(), record.exposure, record.sequence);
    return composited_->shown().texture;
}

void ArWindow::draw(unsigned texture, cv::Size picture, double share)
{
    glm::ivec2 const window_px = window_.framebuffer_px();
    cv::Rect const place = place_of({picture.width, picture.height}, window_px);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    // The top row of a texture comes first, of a window last.
    int const from = int(share * picture.width), to = int(share * place.width);
    glBlitFramebuffer(0, 0, from, picture.height, place.x, place.y + place.height, place.x + to, place.y,
                      GL_COLOR_BUFFER_BIT, picture == place.size() ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (share == 1) return;
    glEnable(GL_SCISSOR_TEST);
    glScissor(place.x + to, place.y, 1, place.height);
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

void ArWindow::keep_shown(cv::Size picture)
{
    glm::ivec2 const window_px = window_.framebuffer_px();
    std::vector<unsigned char> bytes = read_bytes(target_of(window_));
    // Rows from the top: the place is as far from both edges, give or take a pixel.
    cv::Rect place = place_of({picture.width, picture.height}, window_px);
    place.y = window_px.y - place.y - place.height;
    shown_ = cv::Mat(window_px.y, window_px.x, CV_8UC3, bytes.data())(place).clone();
}

void ArWindow::show(ar::RunFrame& record, ar::FrameResult const& result)
{
    take_input();
    if (frames_++ == 0) window_.set_title("Lightwell: augmented reality");
    if (record.state != ar::PoseState::tracked) ++lost_;
    if (result.light.data != light_.data) {
        light_ = result.light;
        if (!light_.empty()) fill(light_texture_, light_);
    }
    if (result.rgb.depth() != CV_8U) report_.lose("frames shown with 8 bits of 16 or more", 1, "the window");
    fill_panel(record);
    unsigned const picture = composite(record, result);
    bind(target_of(window_));
    glDisable(GL_FRAMEBUFFER_SRGB);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    draw(picture, result.camera.size(), 1);
    if (is_split_) {
        fill(camera_, ar::eight_bits_of(result.camera));
        draw(camera_.id(), result.camera.size(), 0.5);
    }
    panel_.draw();
    if (settings_.keeps_shown) keep_shown(result.camera.size());
    window_.swap();
    glFinish();
    double const swapped_s = now_s();
    record.present_ms = 1e3 * (swapped_s - result.done_s) - record.show_wait_ms;
    if (!record.captured_steady_s) return;
    record.swapped_ms = 1e3 * (swapped_s - *record.captured_steady_s);
    if (latency_ms_.size() == kShownLatencies) latency_ms_.erase(latency_ms_.begin());
    latency_ms_.push_back(float(record.swapped_ms));
}

} // namespace viewer
