// The Cornell box as measured (Cornell University Program of Computer Graphics, 1998): corners in the original
// units of about a millimetre, converted to metres; spectra from 400 to 700 nm.

#include "gi/scene/generate/generate.h"
#include "gi/scene/model/spectrum.h"

#include <array>

namespace gi {
namespace {

constexpr std::array<double, 76> kWhite{
    .343, .445, .551, .624, .665, .687, .708, .723, .715, .710, .745, .758, .739, .767, .777, .765,
    .751, .745, .748, .729, .745, .757, .753, .750, .746, .747, .735, .732, .739, .734, .725, .721,
    .733, .725, .732, .743, .744, .748, .728, .716, .733, .726, .713, .740, .754, .764, .752, .736,
    .734, .741, .740, .732, .745, .755, .751, .744, .731, .733, .744, .731, .712, .708, .729, .730,
    .727, .707, .703, .729, .750, .760, .751, .739, .724, .730, .740, .737};
constexpr std::array<double, 76> kGreen{
    .092, .096, .098, .097, .098, .095, .095, .097, .095, .094, .097, .098, .096, .101, .103, .104,
    .107, .109, .112, .115, .125, .140, .160, .187, .229, .285, .343, .390, .435, .464, .472, .476,
    .481, .462, .447, .441, .426, .406, .373, .347, .337, .314, .285, .277, .266, .250, .230, .207,
    .186, .171, .160, .148, .141, .136, .130, .126, .123, .121, .122, .119, .114, .115, .117, .117,
    .118, .120, .122, .128, .132, .139, .144, .146, .150, .152, .157, .159};
constexpr std::array<double, 76> kRed{.040, .046, .048, .053, .049, .050, .053, .055, .057, .056, .059, .057, .061,
                                      .061, .060, .062, .062, .062, .061, .062, .060, .059, .057, .058, .058, .058,
                                      .056, .055, .056, .059, .057, .055, .059, .059, .058, .059, .061, .061, .063,
                                      .063, .067, .068, .072, .080, .090, .099, .124, .154, .192, .255, .287, .349,
                                      .402, .443, .487, .513, .558, .584, .620, .606, .609, .651, .612, .610, .650,
                                      .638, .627, .620, .630, .628, .642, .639, .657, .639, .635, .642};
constexpr std::array<double, 4> kLamp{0, 8, 15.6, 18.4}; // 400, 500, 600, 700 nm
constexpr double kLampAlbedo = 0.78;

using Quad = std::array<dvec3, 4>;

class CornellBuilder {
public:
    int add_material(std::string const& name, Material const& m)
    {
        scene.materials.push_back(m);
        scene.material_names.push_back(name);
        return int(scene.materials.size()) - 1;
    }
    /// @param seen_from a point in front of the quads, or behind them if `outwards`
    void add(std::string const& name, int material, std::vector<Quad> const& quads, dvec3 seen_from, bool outwards)
    {
        Mesh mesh;
        mesh.name = name;
        mesh.material = material;
        for (Quad const& q : quads) {
            dvec3 const n = glm::cross(q[1] - q[0], q[2] - q[0]);
            bool const faces = glm::dot(n, seen_from - q[0]) > 0;
            bool const keep = faces != outwards;
            auto const first = std::uint32_t(mesh.positions.size());
            for (std::size_t i = 0; i < 4; ++i) mesh.positions.push_back(vec3(q[keep ? i : 3 - i] * 0.001));
            mesh.triangles.push_back({first, first + 1, first + 2});
            mesh.triangles.push_back({first, first + 2, first + 3});
        }
        Node node;
        node.name = name;
        node.meshes = {std::int32_t(scene.meshes.size())};
        scene.meshes.push_back(std::move(mesh));
        scene.nodes.push_back(std::move(node));
    }
    Scene scene;
};

} // namespace

Scene generate_cornell()
{
    CornellBuilder b;
    int const white = b.add_material("white", matt(to_rgb({400, 4, kWhite})));
    int const green = b.add_material("green", matt(to_rgb({400, 4, kGreen})));
    int const red = b.add_material("red", matt(to_rgb({400, 4, kRed})));
    Material lamp = matt(vec3{float(kLampAlbedo)});
    lamp.emission = to_rgb({400, 100, kLamp});
    int const light = b.add_material("light", lamp);

    Camera camera = look_at({0.278, 0.273, -0.8}, {0.278, 0.273, 0}, 1);
    camera.name = "camera";
    camera.yfov_rad = 2 * std::atan(0.0125 / 0.035); // film 25 mm high, focal length 35 mm
    Node eye;
    eye.name = camera.name;
    eye.matrix = camera.world_from_camera;
    eye.camera = 0;
    b.scene.cameras.push_back(camera);
    b.scene.nodes.push_back(eye);

    dvec3 const middle{278, 270, 280};
    b.add("floor", white, {Quad{{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}}}, middle, false);
    // The ceiling has a hole at the light.
    dvec3 const l0{343, 548.8, 227}, l1{343, 548.8, 332}, l2{213, 548.8, 332}, l3{213, 548.8, 227};
    dvec3 const c0{556, 548.8, 0}, c1{556, 548.8, 559.2}, c2{0, 548.8, 559.2}, c3{0, 548.8, 0};
    b.add("ceiling", white,
          {Quad{c0, c1, l1, l0}, Quad{c1, c2, l2, l1}, Quad{c2, c3, l3, l2}, Quad{c3, c0, l0, l3}}, middle, false);
    b.add("lamp", light, {Quad{l0, l1, l2, l3}}, middle, false);
    b.add("back wall", white, {Quad{{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}}},
          middle, false);
    b.add("right wall", green, {Quad{{{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}}}, middle,
          false);
    b.add("left wall", red, {Quad{{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}}},
          middle, false);
    b.add("short block", white,
          {Quad{{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
           Quad{{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
           Quad{{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
           Quad{{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
           Quad{{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}}},
          {186, 80, 169}, true);
    b.add("tall block", white,
          {Quad{{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
           Quad{{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
           Quad{{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
           Quad{{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
           Quad{{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}}},
          {368, 165, 351}, true);
    b.scene.name = "cornell";
    return std::move(b.scene);
}

} // namespace gi
