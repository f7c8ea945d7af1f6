#include "ar/calibration/calibration_file.h"

#include "ar/calibration/stmap.h"
#include "ar/camera/camera_doubts.h"
#include "gi/core/durable_file.h"
#include "gi/core/file.h"
#include "gi/core/yaml.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr double kLargest = 1e12;
constexpr char const* kMatrixExample = "!!opencv-matrix {rows: 3, cols: 3, dt: d, data: [...]}";

std::string matrix(std::string const& name, int rows, int cols, std::vector<double> const& values)
{
    std::string data;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0) data += i % 8 == 0 ? ",\n       " : ", ";
        std::string const v = fmt::format("{}", values[i]);
        data += v.find_first_of(".en") == std::string::npos ? v + "." : v; // FileStorage takes 1 for an int
    }
    return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n", name, rows,
                       cols, data);
}

std::vector<double> values_of(cv::Mat const& m)
{
    cv::Mat d;
    m.convertTo(d, CV_64F);
    return d.reshape(1, 1).clone();
}

struct Matrix {
    int rows = 0, cols = 0;
    std::vector<double> values;
};

Matrix read_matrix(gi::Yaml const& y)
{
    y.only_keys({"rows", "cols", "dt", "data"});
    Matrix m;
    m.rows = y.needed("rows", "3").integer(0, 4096);
    m.cols = y.needed("cols", "3").integer(0, 4096);
    if (y.has("dt")) {
        gi::Yaml const type = y.needed("dt", "d");
        if (type.text() != "d" && type.text() != "f")
            throw type.error("values of type '" + type.text().substr(0, 16) + "'", "d and f are read",
                             "write dt: d");
    }
    auto const count = std::size_t(m.rows) * std::size_t(m.cols);
    m.values = y.needed("data", "[...]").numbers(count, -kLargest, kLargest);
    return m;
}

Matrix read_matrix(gi::Yaml const& y, int rows, int cols)
{
    Matrix m = read_matrix(y);
    if (m.rows != rows || m.cols != cols)
        throw y.error(fmt::format("{} is {} x {}", y.path(), m.rows, m.cols),
                      fmt::format("{} x {} is needed", rows, cols), "check which calibration this is");
    return m;
}

/// Names of sensor_msgs/distortion_models.hpp of ROS and of programs around it (Kalibr: radtan, none): the same
/// coefficients as OpenCV's models.
LensModel lens_of_ros(gi::Yaml const& y, std::size_t coefficients)
{
    std::string const name = y.text();
    if (name == "none" || name == "pinhole") return LensModel::pinhole;
    if (name == "plumb_bob" || name == "radtan" || name.empty())
        return coefficients == 0 ? LensModel::pinhole : LensModel::radial_tangential;
    if (name == "rational_polynomial") return LensModel::rational;
    if (name == "equidistant" || name == "fisheye") return LensModel::fisheye;
    throw y.error("the distortion model '" + name.substr(0, 64) + "' is not read",
                  "its coefficients would be taken for others",
                  "calibrate as none, plumb_bob, rational_polynomial or equidistant, or give the lens as a table: "
                  "stmap: FILE.exr");
}

LensModel lens_of(gi::Yaml const& top, std::size_t coefficients)
{
    if (top.has("lens_model")) {
        gi::Yaml const y = top.at("lens_model");
        auto const lens = lens_named(y.text());
        if (!lens)
            throw y.error("'" + y.text().substr(0, 64) + "' is no lens model", "it is unknown",
                          "write pinhole, radial_tangential, rational, fisheye or stmap");
        if (*lens == LensModel::stmap && !top.has("stmap"))
            throw y.error("no 'stmap'", "the lens is a table in a file", "add stmap: FILE.exr");
        return *lens;
    }
    if (top.has("distortion_model")) return lens_of_ros(top.at("distortion_model"), coefficients);
    if (top.has("fisheye_model") && top.at("fisheye_model").text() == "1") return LensModel::fisheye;
    return coefficients == 0   ? LensModel::pinhole
           : coefficients <= 5 ? LensModel::radial_tangential
                               : LensModel::rational;
}

void read_lens(gi::Yaml const& top, CameraModel& c)
{
    gi::Yaml const k = top.needed("camera_matrix", kMatrixExample);
    Matrix const m = read_matrix(k, 3, 3);
    auto const& v = m.values;
    if (std::abs(v[1]) > 1e-9 * std::abs(v[0]) || v[3] != 0 || v[6] != 0 || v[7] != 0 || v[8] != 1)
        throw k.error("camera_matrix is not [fx 0 cx; 0 fy cy; 0 0 1]", "pixel axes are assumed to be orthogonal",
                      "calibrate without skew");
    c.fx = v[0];
    c.cx = v[2];
    c.fy = v[4];
    c.cy = v[5];
    std::string const name =
        !top.has("distortion_coefficients") && top.has("dist_coeffs") ? "dist_coeffs" : "distortion_coefficients";
    std::vector<double> d;
    if (top.has(name)) d = read_matrix(top.at(name)).values;
    if (top.has("stmap")) {
        if (std::any_of(d.begin(), d.end(), [](double k_i) { return k_i != 0; }))
            throw top.at("stmap").error("stmap beside " + name, "the lens would be distorted twice",
                                        "remove one of the two");
        lens_of(top, 0); // its name may still be wrong
        return;
    }
    c.lens = lens_of(top, d.size());
    bool const is_zero = std::all_of(d.begin(), d.end(), [](double k_i) { return k_i == 0; });
    if (c.lens == LensModel::pinhole && is_zero) d.clear(); // programs fill them up
    // 4 of OpenCV's are k1 k2 p1 p2; 14 with zeros behind the eighth are the rational model.
    while (d.size() > 8 && d.back() == 0) d.pop_back();
    auto const needed = std::size_t(coefficient_count(c.lens));
    if (c.lens == LensModel::radial_tangential && d.size() == 4) d.push_back(0);
    if (d.size() != needed)
        throw(top.has(name) ? top.at(name) : top)
            .error(fmt::format("{} distortion coefficients for the lens model {}", d.size(), name_of(c.lens)),
                   fmt::format("it has {}", needed),
                   "0, 4, 5 and 8 are read, thin prisms and tilted sensors are not");
    std::copy(d.begin(), d.end(), c.distortion.begin());
}

glm::ivec2 read_size(gi::Yaml const& top, std::optional<glm::ivec2> given)
{
    constexpr int kMost = 65536;
    if (top.has("image_width") || top.has("image_height"))
        return {top.needed("image_width", "640").integer(1, kMost),
                top.needed("image_height", "480").integer(1, kMost)};
    if (top.has("image_size")) {
        auto const v = top.at("image_size").numbers(2, 1, kMost);
        return {int(v[0]), int(v[1])};
    }
    if (given) return *given;
    throw top.error("the file does not say how large pictures are", "rays depend on the size",
                    "write image_width: 640 and image_height: 480");
}

Photometry read_photometry(gi::Yaml const& top)
{
    Photometry p;
    gi::Yaml const y = top.needed("response", kMatrixExample);
    Matrix const curve = read_matrix(y, 3, 256);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < 256; ++i) {
            double const v = curve.values[256 * c + i];
            if (v < 0 || v > 1e6 || (i > 0 && v < curve.values[256 * c + i - 1]))
                throw y.error(fmt::format("the response of channel {} at byte {} is {}", c, i, v),
                              "responses are non-negative and do not decrease", "calibrate it again");
            p.unit_of_byte[c][i] = float(v);
        }
    if (!(p.unit_of_byte[0][255] > 0 && p.unit_of_byte[1][255] > 0 && p.unit_of_byte[2][255] > 0))
        throw y.error("a response that is 0 everywhere", "all pictures would be black", "calibrate it again");
    if (top.has("vignetting")) {
        gi::Yaml const v = top.at("vignetting");
        Matrix const m = read_matrix(v, 1, 3);
        std::copy(m.values.begin(), m.values.end(), p.vignetting.begin());
        for (int i = 0; i <= 100; ++i) {
            double const r2 = 1e-4 * i * i, left = 1 + r2 * (m.values[0] + r2 * (m.values[1] + r2 * m.values[2]));
            if (!(left > 0.02 && left < 50))
                throw v.error(fmt::format("vignetting leaves {:.3g} of the light at radius {}", left, 0.01 * i),
                              "between 0.02 and 50 is possible", "calibrate it again");
        }
    }
    if (top.has("colour")) {
        gi::Yaml const y_colour = top.at("colour");
        Matrix const m = read_matrix(y_colour, 3, 3);
        for (int i = 0; i < 9; ++i) p.colour.val[i] = float(m.values[std::size_t(i)]);
        if (!(std::abs(cv::determinant(p.colour)) > 1e-4f))
            throw y_colour.error("the colour matrix has no inverse", "colours would be lost",
                                 "calibrate it again");
    }
    if (top.has("radiance_per_unit")) p.radiance_per_unit = top.at("radiance_per_unit").number(1e-9, 1e9);
    if (top.has("reference_exposure")) {
        gi::Yaml const e = top.at("reference_exposure");
        e.only_keys({"time_s", "gain", "red_gain", "blue_gain"});
        auto const number = [&](char const* key) { return e.has(key) ? e.at(key).number(0, 1e6) : 0.0; };
        p.reference = {number("time_s"), number("gain"), number("red_gain"), number("blue_gain")};
    }
    return p;
}

std::string number(double v) { return fmt::format("{}", v); }

} // namespace

Calibration parse_calibration(std::string const& text, std::string const& file, std::optional<glm::ivec2> size_px)
{
    gi::Yaml const top = gi::Yaml::parse(text, file);
    top.keys(); // must be a map with unique keys; other programs' files may have further keys
    Calibration out;
    read_lens(top, out.camera);
    out.camera.size_px = read_size(top, size_px);
    gi::TextLocation const at = top.at("camera_matrix").place();
    check(out.camera, fmt::format("{}:{}:{}", at.file, at.line, at.column));
    if (top.has("stmap")) out.stmap = std::filesystem::path(file).parent_path() / top.at("stmap").text();
    if (top.has("rms_px")) out.rms_px = top.at("rms_px").number(0, 1e6);
    if (top.has("covariance")) {
        int const n = 4 + coefficient_count(out.camera.lens);
        Matrix const m = read_matrix(top.at("covariance"), n, n);
        out.covariance = cv::Mat(m.values, true).reshape(1, n);
    }
    if (top.has("response")) out.photometry = read_photometry(top);
    if (top.has("noise")) {
        gi::Yaml const y = top.at("noise");
        y.only_keys({"read", "photon"});
        out.noise = NoiseModel{y.needed("read", "1e-6").number(0, 1e6), y.needed("photon", "1e-4").number(0, 1e6)};
    }
    if (top.has("provenance")) {
        gi::Yaml const y = top.at("provenance");
        for (std::string const& key : y.keys()) out.provenance.emplace_back(key, y.at(key).text());
    }
    return out;
}

std::string format_calibration(Calibration const& c)
{
    CameraModel const& m = c.camera;
    std::string s = "%YAML:1.0\n---\n";
    s += fmt::format("image_width: {}\nimage_height: {}\nlens_model: {}\n", m.size_px.x, m.size_px.y,
                     name_of(m.lens));
    if (m.lens == LensModel::fisheye) s += "fisheye_model: 1\n";
    s += matrix("camera_matrix", 3, 3, values_of(cv::Mat(camera_matrix(m))));
    if (coefficient_count(m.lens) > 0)
        s += matrix("distortion_coefficients", 1, coefficient_count(m.lens), values_of(distortion_of(m)));
    if (!c.stmap.empty()) s += "stmap: \"" + c.stmap.string() + "\"\n";
    if (c.rms_px > 0) s += "rms_px: " + number(c.rms_px) + "\n";
    if (!c.covariance.empty())
        s += matrix("covariance", c.covariance.rows, c.covariance.cols, values_of(c.covariance));
    if (c.photometry) {
        Photometry const& p = *c.photometry;
        std::vector<double> curve;
        for (auto const& channel : p.unit_of_byte) curve.insert(curve.end(), channel.begin(), channel.end());
        s += matrix("response", 3, 256, curve);
        s += matrix("vignetting", 1, 3, {p.vignetting.begin(), p.vignetting.end()});
        s += matrix("colour", 3, 3, {std::begin(p.colour.val), std::end(p.colour.val)});
        s += "radiance_per_unit: " + number(p.radiance_per_unit) + "\n";
        s += fmt::format("reference_exposure:\n   time_s: {}\n   gain: {}\n   red_gain: {}\n   blue_gain: {}\n",
                         p.reference.time_s, p.reference.gain, p.reference.red_gain, p.reference.blue_gain);
    }
    if (c.noise) s += fmt::format("noise:\n   read: {}\n   photon: {}\n", c.noise->read, c.noise->photon);
    if (!c.provenance.empty()) s += "provenance:\n";
    for (auto const& [key, value] : c.provenance) {
        std::string quoted;
        for (char const ch : value) {
            if (ch == '"' || ch == '\\') quoted += '\\';
            quoted += std::uint8_t(ch) < 32 ? ' ' : ch; // one line each
        }
        s += fmt::format("   {}: \"{}\"\n", key, quoted);
    }
    return s;
}

Calibration read_calibration(std::filesystem::path const& file, std::optional<glm::ivec2> size_px,
                             gi::Report* report)
{
    Calibration c = parse_calibration(gi::read_text(file), file.string(), size_px);
    if (!c.stmap.empty()) c.camera = with_stmap(c.camera, c.stmap, report);
    if (report != nullptr && c.stmap.empty())
        for (std::string const& doubt : doubts_about(c.camera))
            report->lose("in doubt: numbers of the calibration", 1, fmt::format("'{}': {}", file.string(), doubt));
    return c;
}

void write_calibration(std::filesystem::path const& file, Calibration const& c)
{
    check(c.camera, file.string());
    for (auto const& [key, value] : c.provenance)
        if (key.empty() || !std::all_of(key.begin(), key.end(), [](char ch) {
                return (ch >= 'a' && ch <= 'z') || (ch >= 'A' && ch <= 'Z') || (ch >= '0' && ch <= '9') ||
                       ch == '_';
            }))
            throw gi::InputError("'" + key + "' is no key of provenance", "keys are letters, digits and _",
                                 "rename it");
    Calibration relative = c;
    if (!c.stmap.empty()) {
        std::error_code unrelated;
        auto const from = std::filesystem::absolute(file).parent_path();
        auto const there = std::filesystem::relative(std::filesystem::absolute(c.stmap), from, unrelated);
        if (!unrelated && !there.empty()) relative.stmap = there;
    }
    std::string const text = format_calibration(relative);
    parse_calibration(text, file.string()); // refuse to write what could not be read back
    gi::write_durably(file, text);
}

} // namespace ar
