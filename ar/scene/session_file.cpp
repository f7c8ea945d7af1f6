#include "ar/scene/session_file.h"

#include "ar/scene/read_values.h"
#include "gi/core/file.h"
#include "gi/filter/filter_names.h"
#include "gi/methods/registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ar {
namespace {

namespace fs = std::filesystem;
using gi::Yaml;

class Reader {
public:
    Reader(Yaml const& root, fs::path const& file) : root_(root), folder_(file.parent_path())
    {
        session_.file = file;
    }

    Session read()
    {
        root_.only_keys({"schema", "frames", "camera", "markers", "light", "real", "virtual", "render",
                         "composite", "pose", "hmd", "passes", "occlusion"});
        std::string const schema = root_.has("schema") ? root_.at("schema").text() : "";
        if (schema != "ar/1" && schema != "ar/2")
            throw root_.error("no 'schema: ar/2'", "this may be a file of another kind", "begin the file with it");
        is_of_0_1_ = schema == "ar/1";
        if (is_of_0_1_) session_.render.method = gi::kDefaultMethodOf01;
        for (char const* needed : {"frames", "camera", "markers"})
            if (!root_.has(needed))
                throw root_.error(fmt::format("no '{}'", needed), "a session cannot begin without it", "add it");
        read_frames(root_.at("frames"));
        session_.camera = path(root_.at("camera"));
        session_.markers = path(root_.at("markers"));
        if (root_.has("light")) read_light(root_.at("light"));
        if (root_.has("real")) session_.real = read_real(root_.at("real"), folder_);
        if (root_.has("virtual")) session_.virtual_things = virtual_things(root_.at("virtual"));
        if (root_.has("render")) read_render(root_.at("render"));
        if (root_.has("hmd")) session_.hmd = read_hmd(root_.at("hmd"), folder_);
        if (root_.has("composite")) read_composite(root_.at("composite"));
        if (root_.has("pose")) read_pose(root_.at("pose"));
        if (root_.has("occlusion")) {
            session_.occlusion = read_occlusion(root_.at("occlusion"), folder_);
            if (session_.hmd && session_.hmd->right)
                throw root_.at("occlusion")
                    .error("occlusion with two cameras", "its pictures belong to one camera",
                           "remove hmd.right or occlusion");
        }
        if (root_.has("passes")) read_passes(root_.at("passes"));
        return std::move(session_);
    }

private:
    fs::path path(Yaml const& at) const { return folder_ / at.text(); }

    void read_frames(Yaml const& f)
    {
        f.only_keys({"source", "rate_hz", "size", "format", "first"});
        if (!f.has("source"))
            throw f.error("no 'source'", "a session needs frames",
                          "name a camera, a video or a folder of pictures");
        std::string const name = f.at("source").text();
        session_.frames.source = is_device(name) ? name : (folder_ / name).string();
        OpenOptions& o = session_.frames.options;
        if (f.has("rate_hz")) o.frames_per_s = f.at("rate_hz").number(0.01, 1000);
        if (f.has("first")) o.first_number = std::uint64_t(f.at("first").integer(0, 1000000000));
        if (f.has("size")) {
            auto const size = f.at("size").items();
            if (size.size() != 2)
                throw f.at("size").error("not two numbers", "it is a width and a height", "write [640, 480]");
            o.size_px = {int(size[0].integer(16, 16384)), int(size[1].integer(16, 16384))};
        }
        if (f.has("format")) {
            std::vector<std::pair<char const*, PixelFormat>> const formats{
                {"rgb8", PixelFormat::rgb8}, {"bgr8", PixelFormat::bgr8}, {"gray8", PixelFormat::gray8},
                {"nv12", PixelFormat::nv12}, {"yuyv", PixelFormat::yuyv}, {"mjpeg", PixelFormat::mjpeg}};
            o.format = choice<PixelFormat>(f.at("format"), formats);
        }
    }

    void read_light(Yaml const& l)
    {
        l.only_keys({"map", "from", "turn_deg", "scale", "live"});
        if (l.has("live")) session_.live_light = int(l.at("live").integer(0, 100000));
        if (l.has("from")) {
            session_.light_from_frame = choice<bool>(l.at("from"), {{"frame", true}});
            for (char const* key : {"map", "turn_deg", "scale"})
                if (l.has(key))
                    throw l.at(key).error(fmt::format("'{}' beside 'from: frame'", key),
                                          "the light is estimated, in the world's axes and the camera's unit",
                                          "remove one of the two");
            if (!root_.has("real"))
                throw l.at("from").error("'from: frame' without 'real'",
                                         "light is estimated from the shading of known surfaces",
                                         "model the table: real: {planes: [...]}");
        }
        if (l.has("map"))
            session_.light = path(l.at("map"));
        else if (session_.live_light == 0 && !session_.light_from_frame)
            throw l.error("no 'map'", "the light needs a source",
                          "set a lat-long EXR or HDR file, from: frame, or live: 10");
        if (l.has("turn_deg")) session_.light_turn_deg = l.at("turn_deg").number(-360, 360);
        if (l.has("scale")) session_.light_scale = l.at("scale").number(0, 1e9);
    }

    PlacedScene virtual_things(Yaml const& v) const
    {
        v.only_keys({"scene", "at", "turn_deg", "scale"});
        if (!v.has("scene")) throw v.error("no 'scene'", "there is nothing to place", "name a scene file");
        return read_placed(v, "scene", folder_);
    }

    void read_render(Yaml const& r)
    {
        std::vector<std::string> keys{"light", "paths", "resolution", "denoise"};
        if (!is_of_0_1_) keys.push_back("method");
        if (!is_of_0_1_ && r.has("method")) session_.render.method = method(r.at("method"));
        for (gi::RenderOption const& o : gi::render_options()) {
            if (!o.live || !o.read_by(session_.render.method) || o.name == "device") continue; // pairs need the CPU
            std::vector<std::string> names = o.former;
            names.push_back(o.key);
            for (std::string const& key : names)
                if (r.has(key)) set(o, r.at(key));
            keys.insert(keys.end(), names.begin(), names.end());
        }
        r.only_keys(keys);
        if (r.has("light"))
            session_.render.light = choice<PairLight>(r.at("light"), {{"auto", PairLight::automatic},
                                                                      {"prefiltered", PairLight::prefiltered},
                                                                      {"paths", PairLight::paths}});
        if (r.has("denoise")) session_.render.denoise = filter(r.at("denoise"));
        if (r.has("paths")) session_.render.paths = std::uint32_t(r.at("paths").integer(1, 65536));
        if (r.has("resolution")) session_.render.resolution = r.at("resolution").number(0.1, 4);
    }

    static std::string method(Yaml const& at)
    {
        try {
            gi::Method const& chosen = gi::find_method(at.text());
            if (chosen.pairs) return std::string(chosen.name);
        } catch (gi::InputError const& e) {
            throw at.error(e.problem(), e.why(), e.suggestion());
        }
        std::vector<std::string_view> able;
        for (gi::Method const& m : gi::methods())
            if (m.offered && m.pairs) able.push_back(m.name);
        throw at.error("method " + at.text() + " in an AR session",
                       "it cannot render a scene with and without objects with the same random numbers",
                       fmt::format("choose one of {}", fmt::join(able, ", ")));
    }

    void set(gi::RenderOption const& option, Yaml const& at)
    {
        std::string const text = at.text();
        try {
            option.set(session_.render.settings, text, fmt::format("'{}' = {}", option.key, text));
        } catch (gi::InputError const& e) {
            throw at.error(e.problem(), e.why(), e.suggestion());
        }
    }

    static gi::DenoiseSettings filter(Yaml const& at)
    {
        using gi::Denoiser;
        std::vector<std::pair<char const*, gi::DenoiseSettings>> words{{"true", {.denoiser = Denoiser::atrous}},
                                                                       {"false", {.denoiser = Denoiser::none}}};
        for (gi::NamedFilter const& f : gi::named_filters()) words.emplace_back(f.name, f.settings);
        gi::DenoiseSettings const chosen = choice<gi::DenoiseSettings>(at, words);
        gi::check_filter(chosen);
        return chosen;
    }

    void read_composite(Yaml const& c)
    {
        c.only_keys(
            {"blend", "clipped", "largest_ratio", "smoothing", "upsample", "mattes", "match_blur", "noise"});
        if (c.has("upsample")) session_.finish.upsample = c.at("upsample").boolean();
        if (c.has("mattes")) session_.finish.mattes = c.at("mattes").boolean();
        if (c.has("match_blur")) session_.finish.match_blur = c.at("match_blur").boolean();
        if (c.has("noise")) session_.match_noise = c.at("noise").boolean();
        if (c.has("smoothing")) session_.smoothing = c.at("smoothing").number(0.01, 1);
        if (c.has("blend"))
            session_.composite.blend =
                choice<Blend>(c.at("blend"), {{"difference", Blend::difference}, {"ratio", Blend::ratio}});
        if (c.has("clipped"))
            session_.composite.clipped =
                choice<ClippedBytes>(c.at("clipped"), {{"as_measured", ClippedBytes::as_measured},
                                                       {"ratio", ClippedBytes::ratio},
                                                       {"model", ClippedBytes::model}});
        if (c.has("largest_ratio")) session_.composite.largest_ratio = float(c.at("largest_ratio").number(1, 1e6));
    }

    void read_passes(Yaml const& p)
    {
        p.only_keys({"folder", "bits", "undistorted"});
        session_.passes.folder = path(p.needed("folder", "passes"));
        if (p.has("bits")) session_.passes.bits = choice<int>(p.at("bits"), {{"16", 16}, {"32", 32}});
        if (p.has("undistorted")) session_.passes.is_undistorted = p.at("undistorted").boolean();
    }

    /// Reads how the pose is found (by markers, features or a tracker) and used.
    void read_pose(Yaml const& p)
    {
        p.only_keys({"tripod", "smoothing", "predict_s", "least_confidence", "hold_s", "fade_s", "fuse",
                     "features", "display", "tracker", "camera_from_sensor", "world_from_room", "offset_s"});
        TrustSettings& trust = session_.pose.trust;
        if (p.has("hold_s")) trust.hold_s = p.at("hold_s").number(0, 10);
        if (p.has("fade_s")) trust.fade_s = p.at("fade_s").number(0, 10);
        bool is_tracked = false;
        for (char const* key : {"display", "tracker", "camera_from_sensor", "world_from_room", "offset_s"})
            is_tracked |= p.has(key);
        if (!is_tracked) return read_pose_use(p);
        if (p.has("least_confidence"))
            throw p.at("least_confidence")
                .error("'least_confidence' beside a tracker", "its poses have no confidence",
                       "remove one of the two");
        for (char const* key : {"tripod", "smoothing", "predict_s", "fuse", "features"})
            if (p.has(key))
                throw p.at(key).error(fmt::format("'{}' beside a tracker", key),
                                      "filter and prediction of trackers are set in the display file",
                                      "remove one of the two");
        session_.tracked = tracker_use(p);
    }

    TrackerUse tracker_use(Yaml const& p) const
    {
        TrackerUse use;
        if (p.has("display")) use.display = path(p.at("display"));
        if (p.has("tracker")) use.tracker = p.at("tracker").text();
        if (p.has("camera_from_sensor")) read_turned(p.at("camera_from_sensor"), use.camera_from_sensor);
        if (p.has("world_from_room")) read_turned(p.at("world_from_room"), use.world_from_room);
        if (p.has("offset_s")) use.offset_s = p.at("offset_s").number(-1e6, 1e6);
        return use;
    }

    void read_pose_use(Yaml const& p)
    {
        PoseUse& use = session_.pose;
        if (p.has("tripod") && p.at("tripod").boolean()) {
            use.tracker.motion = CameraMotion::tripod;
            use.filtered = true;
        }
        if (p.has("smoothing")) {
            Yaml const s = p.at("smoothing");
            bool const is_on = s.is_map() || s.boolean();
            bool const stands = use.tracker.motion == CameraMotion::tripod;
            if (is_on && stands)
                throw s.error("smoothing of a camera on a tripod", "its poses are averaged",
                              "remove one of the two");
            use.filtered = is_on || stands;
            if (s.is_map()) {
                s.only_keys({"position", "rotation"});
                if (s.has("position")) read_one_euro(s.at("position"), use.tracker.position);
                if (s.has("rotation")) read_one_euro(s.at("rotation"), use.tracker.rotation);
            }
        }
        if (p.has("features")) use.features = path(p.at("features"));
        use.fused = !use.filtered; // averaged or smoothed already
        if (p.has("fuse")) {
            use.fused = p.at("fuse").boolean();
            if (use.fused && use.tracker.motion == CameraMotion::tripod)
                throw p.at("fuse").error("fusion of a camera on a tripod", "its poses are averaged",
                                         "remove one of the two");
        }
        if (p.has("least_confidence")) use.trust.least_confidence = p.at("least_confidence").number(0, 1);
        if (p.has("predict_s")) use.predict_s = p.at("predict_s").number(0, 10);
        use.tracker.predict_s = std::max(use.tracker.predict_s, use.predict_s);
        use.tracker.lost_after_s = std::max(use.tracker.lost_after_s, 2 * use.predict_s);
    }

    static void read_one_euro(Yaml const& y, gi::OneEuroSettings& s)
    {
        y.only_keys({"min_cutoff_hz", "beta"});
        if (y.has("min_cutoff_hz")) s.min_cutoff_hz = y.at("min_cutoff_hz").number(1e-3, 1e3);
        if (y.has("beta")) s.beta = y.at("beta").number(0, 1e4);
    }

    Yaml const& root_;
    fs::path folder_;
    Session session_;
    bool is_of_0_1_ = false; ///< written for version 0.1, which had other methods
};

} // namespace

Session parse_session(std::string const& text, fs::path const& file)
{
    Yaml const root = Yaml::parse(text, file.string(), "session");
    return Reader(root, file).read();
}

Session read_session(fs::path const& file)
{
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(1) << 20);
    return parse_session({bytes.begin(), bytes.end()}, file);
}

} // namespace ar
