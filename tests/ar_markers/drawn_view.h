#pragma once
// Pictures of markers with known truth: drawings at high resolution, seen through a CameraModel with several rays
// per pixel, blurred, noisy, in sRGB bytes.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"
#include "ar/markers/draw.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ar::test {

struct ViewSettings {
    double dots_per_m = 4000;
    int rays = 4;                                        ///< each way per pixel
    double blur_px = 0.5;                                ///< sigma of a Gaussian, of light
    double noise = 0.006;                                ///< sigma of encoded values in 0..1: 1.5 bytes
    double white = 0.8, black = 0.04, background = 0.18; ///< light
    std::uint64_t seed = 1;
};

class DrawnWorld {
public:
    DrawnWorld(MarkerMap map, CameraModel camera, ViewSettings settings = {})
        : map_(std::move(map)), camera_(camera), settings_(settings)
    {
        for (int i = 0; i < count_of(map_); ++i) {
            Sheet const sheet = sheet_of(map_, i);
            cv::Mat light;
            draw(sheet, settings_.dots_per_m)
                .convertTo(light, CV_32F, (settings_.white - settings_.black) / 255, settings_.black);
            sheets_.push_back({sheet, light, world_from_thing(map_, i)});
        }
        // Rays at the corners of pixels; within a pixel they are linear to 1e-6.
        cv::Size const size(camera_.size_px.x + 1, camera_.size_px.y + 1);
        rays_.create(size, CV_64FC3);
        cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
            for (int y = rows.start; y < rows.end; ++y)
                for (int x = 0; x < size.width; ++x) {
                    auto const d = direction_of(camera_, {x - 0.5, y - 0.5});
                    rays_.at<cv::Vec3d>(y, x) = d ? cv::Vec3d(d->x, d->y, d->z) : cv::Vec3d(0, 0, 0);
                }
        });
    }

    /// Light per pixel, CV_32F, before blur and noise.
    cv::Mat light(gi::RigidPose const& world_from_camera) const
    {
        cv::Mat out(camera_.size_px.y, camera_.size_px.x, CV_32F);
        std::vector<gi::RigidPose> things_from_camera;
        for (auto const& s : sheets_)
            things_from_camera.push_back(inverse(s.world_from_thing) * world_from_camera);
        std::vector<glm::dmat3> turns;
        for (gi::RigidPose const& p : things_from_camera) turns.push_back(glm::mat3_cast(p.rotation));
        int const n = settings_.rays;
        cv::parallel_for_({0, out.rows}, [&](cv::Range const& rows) {
            for (int y = rows.start; y < rows.end; ++y)
                for (int x = 0; x < out.cols; ++x) {
                    double sum = 0;
                    for (int j = 0; j < n; ++j)
                        for (int i = 0; i < n; ++i) {
                            double const u = (i + 0.5) / n, v = (j + 0.5) / n;
                            cv::Vec3d const r = (1 - v) * ((1 - u) * ray(y, x) + u * ray(y, x + 1)) +
                                                v * ((1 - u) * ray(y + 1, x) + u * ray(y + 1, x + 1));
                            sum += seen({r[0], r[1], r[2]}, things_from_camera, turns);
                        }
                    out.at<float>(y, x) = float(sum / (n * n));
                }
        });
        return out;
    }

    /// CV_8UC1.
    cv::Mat picture(gi::RigidPose const& world_from_camera, std::uint64_t number = 0) const
    {
        cv::Mat p = light(world_from_camera);
        if (settings_.blur_px > 0) cv::GaussianBlur(p, p, {}, settings_.blur_px);
        cv::RNG rng(settings_.seed * 1000003 + number);
        cv::Mat bytes(p.size(), CV_8U);
        for (int y = 0; y < p.rows; ++y)
            for (int x = 0; x < p.cols; ++x) {
                double const v = p.at<float>(y, x);
                double const encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
                bytes.at<std::uint8_t>(y, x) =
                    cv::saturate_cast<std::uint8_t>(255 * (encoded + rng.gaussian(settings_.noise)));
            }
        return bytes;
    }

    /// Distances between points of a sighting and where they really are, pixels.
    std::vector<double> errors(Sighting const& s, gi::RigidPose const& world_from_camera) const
    {
        std::vector<double> all;
        gi::RigidPose const camera_from_world = inverse(world_from_camera);
        for (auto const& p : s.points) {
            auto const truth = project(camera_, camera_from_world * p.world_m);
            all.push_back(truth ? glm::distance(*truth, p.pixel) : 1e3);
        }
        return all;
    }
    MarkerMap const& map() const { return map_; }
    CameraModel const& camera() const { return camera_; }

private:
    struct Placed {
        Sheet sheet;
        cv::Mat light;
        gi::RigidPose world_from_thing;
    };
    cv::Vec3d ray(int y, int x) const { return rays_.at<cv::Vec3d>(y, x); }
    double seen(glm::dvec3 direction, std::vector<gi::RigidPose> const& from_camera,
                std::vector<glm::dmat3> const& turns) const
    {
        double nearest = 1e30, value = settings_.background;
        for (std::size_t k = 0; k < sheets_.size(); ++k) {
            glm::dvec3 const d = turns[k] * direction;
            glm::dvec3 const o = from_camera[k].position;
            double const t = -o.z / d.z;
            if (!(d.z < 0 && t > 0 && t < nearest)) continue; // seen from the front
            Sheet const& s = sheets_[k].sheet;
            glm::dvec2 const at = glm::dvec2(o + t * d) + s.origin_m;
            if (!(at.x >= 0 && at.y >= 0 && at.x < s.width_m && at.y < s.height_m)) continue;
            nearest = t;
            cv::Mat const& m = sheets_[k].light;
            double const px = std::clamp(at.x * settings_.dots_per_m - 0.5, 0., m.cols - 1.001);
            double const py = std::clamp((s.height_m - at.y) * settings_.dots_per_m - 0.5, 0., m.rows - 1.001);
            int const ix = int(px), iy = int(py);
            double const fx = px - ix, fy = py - iy;
            float const *a = m.ptr<float>(iy) + ix, *b = m.ptr<float>(iy + 1) + ix;
            value = (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
        }
        return value;
    }

    MarkerMap map_;
    CameraModel camera_;
    ViewSettings settings_;
    std::vector<Placed> sheets_;
    cv::Mat rays_;
};

/// A camera at `eye` that looks at `target`, its picture's top towards `up`.
inline gi::RigidPose looking(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up = {0, 1, 0})
{
    glm::dvec3 const z = glm::normalize(target - eye), x = glm::normalize(glm::cross(z, up)), y = glm::cross(z, x);
    return {eye, glm::normalize(glm::quat_cast(glm::dmat3(x, y, z)))};
}

inline double rms(std::vector<double> const& v)
{
    double sum = 0;
    for (double x : v) sum += x * x;
    return v.empty() ? 0 : std::sqrt(sum / double(v.size()));
}

} // namespace ar::test
