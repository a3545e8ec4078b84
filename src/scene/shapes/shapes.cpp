#include "scene/shapes.h"

#include <pellucid/error.h>
#include <pellucid/names.h>

#include "core/fail.h"
#include "scene/shapes/shape_arguments.h"
#include "scene/shapes/shape_builders.h"

namespace pellucid {
namespace {

struct Shape {
    ShapeInfo info;
    Mesh (*make)(const ShapeArguments&);
};

/// The maxima keep every shape below 20 million triangles.
const std::vector<Shape>& shapes() {
    static const std::vector<Shape> table = {
        {{"sphere",
          "ball, evenly tessellated from an octahedron",
          {{"segments", 64, 1, 1500, "rows from pole to equator; 8 segments^2 triangles (8: 512)"},
           {"radius", 1.0, 0.01, 100, "metres"}}},
         make_sphere},
        {{"cube",
          "cube with flat faces",
          {{"size", 1.2, 0.01, 100, "length of an edge, metres"},
           {"segments", 1, 1, 1000, "quads along an edge; 12 segments^2 triangles"}}},
         make_cube},
        {{"slab",
          "pane with flat faces, thin along Z",
          {{"width", 1.6, 0.01, 100, "along X, metres"},
           {"height", 1.2, 0.01, 100, "along Y, metres"},
           {"thickness", 0.3, 0.001, 100, "along Z, metres"},
           {"segments", 1, 1, 1000, "quads along an edge; 12 segments^2 triangles"}}},
         make_slab},
        {{"torus",
          "ring standing in the XY plane",
          {{"segments", 192, 3, 3000, "around the ring; 2 segments sides triangles (24 x 12: 576)"},
           {"sides", 96, 3, 3000, "around the tube"},
           {"radius", 0.7, 0.01, 100, "of the tube's centre line, metres"},
           {"tube", 0.3, 0.001, 100, "radius of the tube, metres; less than radius"}}},
         make_torus},
        {{"infinity-ring",
          "closed tube along a lemniscate in the XY plane, one strand passing before the other",
          {{"segments", 256, 16, 3000, "along the tube; 2 segments sides triangles (60 x 20: 2400)"},
           {"sides", 48, 3, 3000, "around the tube"},
           {"tube", 0.16, 0.01, 0.2, "radius of the tube, metres"},
           {"lift", 1.3, 1.05, 3, "half the distance of the strands where they cross, in radii of the tube"}}},
         make_infinity_ring},
        {{"knot",
          "closed tube along a (p, q) torus knot around the Z axis",
          {{"p", 2, 1, 12, "turns around the axis; p and q share no factor"},
           {"q", 3, 1, 12, "turns around the torus"},
           {"segments", 384, 16, 4000, "along the tube; 2 segments sides triangles"},
           {"sides", 48, 3, 2400, "around the tube"},
           {"tube", 0.14, 0.005, 0.3, "radius of the tube, metres"}}},
         make_knot},
        {{"goblet",
          "wine glass with foot, stem and a bowl with walls, 2 m high",
          {{"segments", 160, 3, 3000, "around the axis; 2 segments (rings - 1) triangles"},
           {"rings", 200, 24, 3000, "along the profile"},
           {"wall", 0.035, 0.008, 0.08, "thickness of the bowl's wall, metres"}}},
         make_goblet},
        {{"bottle",
          "open bottle with grooves around its body and a hollow inside, 2 m high",
          {{"segments", 160, 3, 3000, "around the axis; 2 segments (rings - 1) triangles"},
           {"rings", 320, 64, 3000, "along the profile"},
           {"grooves", 4, 1, 8, "around the body"},
           {"wall", 0.03, 0.008, 0.06, "thickness of the wall, metres"}}},
         make_bottle},
        {{"vase",
          "open vase with a belly, a neck and a lip, 2 m high",
          {{"segments", 160, 3, 3000, "around the axis"},
           {"rings", 240, 48, 3000, "along the profile"},
           {"wall", 0.04, 0.008, 0.12, "thickness of the wall, metres"},
           {"half", 0, 0, 1, "1: the half behind the plane z = 0, cut flat"}}},
         make_vase},
        {{"gem",
          "brilliant-cut diamond with flat facets, table upwards, 1 m in girdle radius",
          {{"facets", 8, 5, 64, "main facets around; 14 facets - 2 triangles"},
           {"table", 0.55, 0.3, 0.7, "radius of the table, in girdle radii"},
           {"crown_deg", 34.5, 10, 60, "slope of the main facets above the girdle, degrees"},
           {"pavilion_deg", 40.75, 20, 60, "slope of the main facets below the girdle, degrees"},
           {"girdle", 0.04, 0.005, 0.2, "height of the girdle, metres"}}},
         make_gem},
        {{"hollow-sphere",
          "ball with a concentric cavity",
          {{"segments", 64, 1, 1000, "rows from pole to equator; 16 segments^2 triangles"},
           {"radius", 1.0, 0.01, 100, "outer radius, metres"},
           {"inner", 0.8, 0.05, 0.99, "radius of the cavity, in outer radii"}}},
         make_hollow_sphere},
    };
    return table;
}

}  // namespace

const std::vector<ShapeInfo>& shape_infos() {
    static const std::vector<ShapeInfo> infos = [] {
        std::vector<ShapeInfo> result;
        for (const Shape& shape : shapes()) result.push_back(shape.info);
        return result;
    }();
    return infos;
}

Mesh load_shape(const std::string& spec) {
    const std::string name = spec.substr(0, spec.find(','));
    std::vector<std::string_view> known;
    for (const Shape& shape : shapes()) {
        if (shape.info.name == name) {
            const std::string_view arguments = std::string_view(spec).substr(name.size());
            Mesh mesh = shape.make(ShapeArguments(shape.info, arguments));
            mesh.name = name;
            return mesh;
        }
        known.push_back(shape.info.name);
    }
    throw unknown_name("shape", shortened(name), known);
}

}  // namespace pellucid
