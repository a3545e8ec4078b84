// Valid mesh files as programs write them: each gives the same cube, without a word. And what is refused, with reasons.
#include "scene/mesh_files/triangulate_polygon.h"
#include "scene/mesh_repair.h"
#include "test_bytes.h"
#include "test_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace pellucid {
namespace {

using test::append;
using test::broken_promise;
using test::load_error;
using test::TemporaryFolder;
using test::warnings_with;

// The cube from 0 to 1: 8 vertices, 6 quads.
constexpr std::array<std::array<int, 4>, 6> kQuads = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

std::string coordinates(int vertex) {
    return std::to_string(vertex & 1) + ' ' + std::to_string(vertex >> 1 & 1) + ' ' + std::to_string(vertex >> 2);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

std::string utf16(const std::string& text, bool big_endian, bool mark) {
    std::string bytes;
    if (mark) append(bytes, std::uint16_t(0xfeff), big_endian);
    for (const char c : text) append(bytes, std::uint16_t(c), big_endian);
    return bytes;
}

/// The cube, whatever the file says how.
void expect_cube(const TemporaryFolder& folder, const std::string& name, const std::string& content,
                 const std::string& warning = "") {
    SCOPED_TRACE(name);
    Scene scene;
    ASSERT_NO_THROW(scene = load_scene(folder.file(name, content)));
    EXPECT_EQ(broken_promise(scene), "");
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.triangle_count(), 12u);
    EXPECT_EQ(scene.meshes[0].positions.size(), 24u) << "edges are sharp";
    EXPECT_NEAR(signed_volume(scene.meshes[0]).value, 1.0, 1e-6);
    EXPECT_EQ(scene.origin + glm::dvec3(scene_bounds(scene).center), glm::dvec3(0.5));
    if (warning.empty()) {
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    } else {
        EXPECT_EQ(warnings_with(scene, warning), 1u);
        EXPECT_EQ(scene.warnings.size(), 1u) << scene.warnings.back();
    }
}

std::string obj(const std::function<std::string(int)>& vertex, const std::function<std::string(int)>& corner) {
    std::string text;
    for (int v = 0; v < 8; ++v) text += "v " + vertex(v) + '\n';
    for (const auto& quad : kQuads) {
        text += 'f';
        for (const int v : quad) text += ' ' + corner(v);
        text += '\n';
    }
    return text;
}
std::string obj() {
    return obj(coordinates, [](int v) { return std::to_string(v + 1); });
}

TEST(MeshFormats, ObjAsProgramsWriteIt) {
    const TemporaryFolder folder;
    const std::string text = obj();
    expect_cube(folder, "quads.obj", text);
    expect_cube(folder, "windows.obj", replaced(text, "\n", "\r\n"));
    expect_cube(folder, "old-mac.obj", replaced(text, "\n", "\r"));
    expect_cube(folder, "tabs.obj", replaced(text, " ", "\t "));
    expect_cube(folder, "blanks-at-ends.obj", replaced(text, "\n", "  \n\n  "));
    expect_cube(folder, "no-last-end.obj", text.substr(0, text.size() - 1));
    expect_cube(folder, "comments.obj", "# C:\\folder\\\n" + replaced(text, "\n", " # a\n"));
    expect_cube(folder, "continued.obj", replaced(replaced(text, "f ", "f \\\n"), " 1\n", " \\\r\n 1\n"));
    expect_cube(folder, "continued-at-end.obj", text + "\\");
    expect_cube(folder, "mark.obj", "\xef\xbb\xbf" + text);
    for (const bool big : {false, true})
        for (const bool mark : {false, true}) expect_cube(folder, "utf16.obj", utf16(text, big, mark));
    expect_cube(folder, "negative.obj", obj(coordinates, [](int v) { return std::to_string(v - 8); }));
    const auto with_weight = [](int v) { return coordinates(v) + " 0.5"; };
    const auto plain = [](int v) { return std::to_string(v + 1); };
    expect_cube(folder, "weight.obj", obj(with_weight, plain));
    expect_cube(folder, "faces-first.obj", text.substr(text.find('f')) + text.substr(0, text.find('f')));
    expect_cube(folder, "no-vt-no-vn.obj", obj(coordinates, [](int v) {
                    return std::to_string(v + 1) + "/" + std::to_string(v + 1) + "/" + std::to_string(v + 1);
                }));
    expect_cube(folder, "slashes.obj", obj(coordinates, [](int v) { return std::to_string(v + 1) + "//"; }));
    expect_cube(folder, "groups.obj", "g\no\ns off\ng a b\ng empty\n" + text + "g last\nusemtl one\n");
    expect_cube(folder, "numbers.obj",
                replaced(replaced(text, "v 1 1 1", "v +1.0 1e0 10.E-1"), "v 0 0 0", "v -0 1e-400 .0"));
    expect_cube(folder, "white.obj", obj([](int v) { return coordinates(v) + " 1 1 1"; }, plain));
    expect_cube(folder, "colors.obj", obj([](int v) { return coordinates(v) + " 1 0.5 0"; }, plain), "colours");
    expect_cube(folder, "unused-nan.obj", text + "v nan 0 1.#QNAN\n");
    expect_cube(folder, "unknown.obj", text + "xyz 1 2\n",
                "1 line not understood, left out; the first is line 15 \"xyz\"");
    expect_cube(folder, "surfaces.obj", text + "vp 1 2\ncstype bspline\nsurf 0 1 0 1 1 2\nend\n",
                "1 free-form curves and surfaces left out");
}

TEST(MeshFormats, ObjIsRefusedWithALine) {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& text) { return load_error(folder.file("a.obj", text)); };
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const std::pair<std::string, const char*> cases[] = {
        {"v 0 0\n" + vertices + "f 1 2 3\n", "line 1: a vertex has 2 coordinates instead of 3"},
        {"v 0 x 0\n" + vertices, "line 1: \"x\" is no number"},
        {"v 1,5 0 0\n" + vertices, "line 1: \"1,5\" is no number"},
        {vertices + "f 1 2 a\n", "line 4: \"a\" is no corner of a face"},
        {vertices + "f 1 2 4\n", "line 4: face refers to vertex 4, there are 3"},
        {vertices + "f 1 2 -4\n", "line 4: face refers to a vertex that does not exist: -4 of 3"},
        {vertices + "f 1 2 99999999999999999999\n", "line 4: face refers to a vertex that does not exist"},
        {vertices + "vn 0 0 1\nf 1//1 2//1 3//2\n", "line 5: face refers to normal 2, there are 1"},
        {"v nan 0 0\n" + vertices + "f 1 2 3\n", "vertex 1 at nan 0 0 is not finite"},
        {"v 1e400 0 0\n" + vertices + "f 1 2 3\n", "vertex 1 at inf 0 0 is not finite"},
        {"v 1e30 0 0\n" + vertices + "f 1 2 3\n", "vertex 1 at 1e+30 0 0: positions are too large (more than 1e15)"},
        {vertices, "contains no triangles, only 3 points; make a surface of them first"},
        {vertices + "l 1 2\n", "contains no triangles, only 1 lines"}};
    for (const auto& [text, message] : cases) EXPECT_NE(error(text).find(message), std::string::npos) << error(text);
}

/// The area of a polygon's triangles, each of which must be wound as the polygon is.
double covered(const std::vector<glm::dvec3>& polygon) {
    double sum = 0.0;
    for (const auto& [a, b, c] : triangulate_polygon(polygon)) {
        const double area = glm::cross(polygon[b] - polygon[a], polygon[c] - polygon[a]).z / 2.0;
        EXPECT_GE(area, 0.0);
        sum += area;
    }
    return sum;
}

TEST(MeshFormats, ConcavePolygonsAreFilled) {
    const std::vector<glm::dvec3> arrow = {{0, 0, 0}, {2, 2, 0}, {0, 1, 0}, {-2, 2, 0}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        std::vector<glm::dvec3> turned = arrow;
        std::rotate(turned.begin(), turned.begin() + std::ptrdiff_t(turn), turned.end());
        EXPECT_NEAR(covered(turned), 2.0, 1e-12) << turn;
    }
    // A comb, and a square with a square hole that a bridge leads to.
    std::vector<glm::dvec3> comb = {{0, 2, 0}, {0, 0, 0}, {20, 0, 0}};
    for (int tooth = 10; tooth-- > 0;) {
        comb.emplace_back(2.0 * tooth + 2.0, 2.0, 0.0);
        comb.emplace_back(2.0 * tooth + 1.0, 0.5, 0.0);
    }
    EXPECT_NEAR(covered(comb), 25.0, 1e-9);
    EXPECT_EQ(triangulate_polygon(comb).size(), comb.size() - 2);
    EXPECT_NEAR(covered({{0, 0, 0},
                         {3, 0, 0},
                         {3, 3, 0},
                         {0, 3, 0},
                         {0, 0, 0},
                         {1, 1, 0},
                         {1, 2, 0},
                         {2, 2, 0},
                         {2, 1, 0},
                         {1, 1, 0}}),
                8.0, 1e-12);
    // Corners in one line, twice the same corner, a star that crosses itself, nothing at all.
    EXPECT_NEAR(covered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}}), 4.0, 1e-12);
    EXPECT_EQ(triangulate_polygon(std::vector<glm::dvec3>(5, glm::dvec3(1.0))).size(), 0u);
    std::vector<glm::dvec3> star;
    for (int i = 0; i < 5; ++i) star.emplace_back(std::cos(i * 2.5132741), std::sin(i * 2.5132741), 0.0);
    EXPECT_EQ(triangulate_polygon(star).size(), 3u);
    std::vector<glm::dvec3> large;
    for (int i = 0; i < 20000; ++i) large.emplace_back(std::cos(i * 1.0), std::sin(i * 1.0), 0.0);
    EXPECT_EQ(triangulate_polygon(large).size(), large.size() - 2) << "in no time";
}

struct PlyOptions {
    std::string format = "ascii", line_end = "\n", coordinate = "float", count = "uchar", index = "int";
    std::string before, list = "vertex_indices", extra_property;
};

std::string ply(const PlyOptions& o) {
    std::string text = "ply\nformat " + o.format + " 1.0\ncomment made\n\nobj_info x\n";
    if (!o.before.empty())
        text += "element material 1\nproperty " + o.coordinate + " a\nproperty list uchar " + o.index + " b\n";
    text += "element vertex 8\nproperty " + o.coordinate + " x\nproperty " + o.coordinate + " y\nproperty " +
            o.coordinate + " z\n" + o.extra_property + "element face 6\nproperty list " + o.count + " " + o.index +
            " " + o.list + "\nend_header\n";
    text = replaced(text, "\n", o.line_end);
    const bool ascii = o.format == "ascii", big = o.format == "binary_big_endian";
    const auto put = [&](const std::string& type, int value) {
        if (ascii) return void(text += std::to_string(value) + " ");
        if (type == "float" || type == "float32") append(text, float(value), big);
        if (type == "double") append(text, double(value), big);
        if (type == "uchar" || type == "char" || type == "uint8") append(text, std::uint8_t(value));
        if (type == "short" || type == "ushort") append(text, std::uint16_t(value), big);
        if (type == "int" || type == "uint" || type == "int32") append(text, std::uint32_t(value), big);
    };
    if (!o.before.empty()) put(o.coordinate, 7), put("uchar", 2), put(o.index, 1), put(o.index, 2);
    for (int v = 0; v < 8; ++v) {
        for (int k = 0; k < 3; ++k) put(o.coordinate, v >> k & 1);
        if (!o.extra_property.empty()) put("uchar", 1), put("float", 5);
        if (ascii) text += o.line_end;
    }
    for (const auto& quad : kQuads) {
        put(o.count, 4);
        for (const int v : quad) put(o.index, v);
        if (ascii) text += o.line_end;
    }
    return text;
}

TEST(MeshFormats, PlyAsProgramsWriteIt) {
    const TemporaryFolder folder;
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        SCOPED_TRACE(format);
        PlyOptions o;
        o.format = format;
        expect_cube(folder, "plain.ply", ply(o));
        for (const char* end : {"\n", "\r\n", "\r"}) {
            o.line_end = end;
            expect_cube(folder, "line-ends.ply", ply(o));
        }
        o.line_end = "\n";
        o.before = "yes";
        expect_cube(folder, "element-before.ply", ply(o));
        o.before.clear();
        o.extra_property = "property list uchar float weights\n";
        expect_cube(folder, "list-in-vertex.ply", ply(o));
        o.extra_property.clear();
        for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint"}) {
            o.count = o.index = type;
            expect_cube(folder, "types.ply", ply(o));
        }
        for (const char* type : {"double", "short", "uchar", "float32"}) {
            o.coordinate = type;
            expect_cube(folder, "coordinates.ply", ply(o));
        }
        o.list = "vertex_index";
        expect_cube(folder, "vertex-index.ply", ply(o));
        o.list = "indices";
        expect_cube(folder, "other-name.ply", ply(o));
    }
    expect_cube(folder, "mark.ply", "\xef\xbb\xbf" + ply({}));
    // The first byte of the body is a line feed, for each way to end lines.
    for (const char* end : {"\n", "\r\n", "\r"}) {
        PlyOptions o;
        o.format = "binary_little_endian";
        o.line_end = end;
        o.before = "yes";
        o.coordinate = "uchar";
        std::string bytes = ply(o);
        const std::size_t body = bytes.find("end_header") + 10 + o.line_end.size();
        for (const char first : {'\n', '\r', ' ', '\0', '\x80'}) {
            bytes[body] = first;
            expect_cube(folder, "first-byte.ply", bytes);
        }
    }
    std::string colors = replaced(ply({}), "float z\n", "float z\nproperty uchar red\n");
    for (int v = 0; v < 8; ++v)
        colors = replaced(colors, "\n" + coordinates(v) + " \n", "\n" + coordinates(v) + " 9\n");
    expect_cube(folder, "colors.ply", colors, "colours of vertices are not used");
}

TEST(MeshFormats, PlyStripsAndOtherFaces) {
    const TemporaryFolder folder;
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    // One strip around a tetrahedron, and two with a restart.
    for (const char* strip : {"6 0 1 3 2 0 1", "9 0 1 3 2 -1 3 2 0 1"}) {
        const Scene scene = load_scene(folder.file(
            "strips.ply", header + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                              vertices + strip + "\n"));
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_EQ(scene.triangle_count(), 4u) << strip;
        EXPECT_NEAR(signed_volume(scene.meshes[0]).value, 1.0 / 6.0, 1e-6) << strip;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    }
    const auto error = [&](const std::string& text) { return load_error(folder.file("a.ply", text)); };
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::pair<std::string, const char*> cases[] = {
        {header + "end_header\n" + vertices, "contains no triangles, only 4 points; make a surface of them first"},
        {header + faces + vertices + "3 0 1 4\n", "PLY: face 0: refers to vertex 4, there are 4"},
        {header + faces + vertices + "3 0 1\n", "PLY: face 0: the file ends early"},
        {header + faces + vertices + "3 0 1 0.5\n", "PLY: face 0: 0.5 where a whole number is expected"},
        {header + faces + "0 0 0\n1 x 0\n", "PLY: vertex 1: \"x\" is no number"},
        {header + faces + vertices + "3 0 1 2\n9\n", "there is more data than the header announces"},
        {replaced(header, "float y", "floot y") + faces, "line 5: the property is malformed"},
        {replaced(header, "ascii", "binary") + faces, "line 2: unknown format \"binary\""},
        {replaced(header, "vertex 4", "vertex -4") + faces, "line 3: the number of elements \"vertex\" is \"-4\""},
        {replaced(header, " x", " q") + faces + vertices + "3 0 1 2\n", "vertices have no x, y and z"}};
    for (const auto& [text, message] : cases) EXPECT_NE(error(text).find(message), std::string::npos) << error(text);
}

std::string ascii_stl() {
    std::string text = "solid cube\n";
    for (const auto& quad : kQuads)
        for (const int second : {1, 2})
            text += "facet normal 0 0 0\nouter loop\nvertex " + coordinates(quad[0]) + "\nvertex " +
                    coordinates(quad[std::size_t(second)]) + "\nvertex " + coordinates(quad[std::size_t(second) + 1]) +
                    "\nendloop\nendfacet\n";
    return text + "endsolid cube\n";
}

std::string binary_stl(std::string header, std::uint32_t announced = 12) {
    header.resize(80, ' ');
    append(header, announced);
    for (const auto& quad : kQuads) {
        for (const std::size_t second : {1u, 2u}) {
            header.append(12, '\0');
            for (const int v : {quad[0], quad[second], quad[second + 1]})
                for (int k = 0; k < 3; ++k) append(header, float(v >> k & 1));
            append(header, std::uint16_t(0));
        }
    }
    return header;
}

TEST(MeshFormats, StlAsProgramsWriteIt) {
    const TemporaryFolder folder;
    const std::string text = ascii_stl();
    std::string upper = text;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
    expect_cube(folder, "plain.stl", text);
    expect_cube(folder, "upper.stl", upper);
    expect_cube(folder, "leading-blank.stl", " \n\t" + replaced(text, "\n", "\n  "));
    expect_cube(folder, "windows.stl", replaced(text, "\n", "\r\n"));
    expect_cube(folder, "old-mac.stl", replaced(text, "\n", "\r"));
    expect_cube(folder, "no-name.stl", replaced(replaced(text, "solid cube", "solid"), "endsolid cube", "endsolid"));
    expect_cube(folder, "names.stl", replaced(text, "solid cube", "solid facet vertex 1 2 3 endfacet"));
    expect_cube(folder, "two-solids.stl",
                std::string(text).insert(text.find("facet normal", 300), "endsolid a\nsolid b\n"));
    expect_cube(folder, "nan-normals.stl", replaced(text, "normal 0 0 0", "normal nan -nan(ind) 1.#QNAN"));
    expect_cube(folder, "no-normals.stl", replaced(text, "facet normal 0 0 0", "facet"));
    expect_cube(folder, "mark.stl", "\xef\xbb\xbf" + text);
    expect_cube(folder, "utf16.stl", utf16(text, false, true));
    expect_cube(folder, "no-endsolid.stl", text.substr(0, text.rfind("endsolid")));

    expect_cube(folder, "binary.stl", binary_stl("a"));
    expect_cube(folder, "solid.stl", binary_stl("solid cube facet"));
    expect_cube(folder, "trailing.stl", binary_stl("a") + "trailing");
    expect_cube(folder, "solid-trailing.stl", binary_stl("solid with a facet") + std::string(7, '\0'));
    expect_cube(folder, "zeros.stl", binary_stl(std::string(80, '\0')));
    for (const std::uint32_t count : {0u, 0xffffffffu})
        expect_cube(folder, "uncounted.stl", binary_stl("a", count), "all 12 that it has are read");
    expect_cube(folder, "more.stl", binary_stl("a") + std::string(100, '\0'),
                "announces 12 triangles; the 2 that follow them are left out");
}

TEST(MeshFormats, StlIsRefusedWithAPlace) {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& text) { return load_error(folder.file("a.stl", text)); };
    const std::string text = ascii_stl();
    const std::pair<std::string, const char*> cases[] = {
        {binary_stl("a", 13), "STL: announces 13 triangles, has 12 in its 684 bytes"},
        {binary_stl("a").substr(0, 600), "STL: announces 12 triangles, has 10 in its 600 bytes"},
        {"nothing", "is no STL file: it is too short"},
        {"solid a\nendsolid a\n", "STL: no facets"},
        {text.substr(0, text.rfind("endfacet")), "STL: the last facet is incomplete"},
        {replaced(text, "vertex 1 1 1", "vertex 1 x 1"), "STL: line 20: \"x\" is no coordinate of a vertex"},
        {replaced(text, "endloop\n", "endloop\nfacet normal 0 0 0\n"), "STL: line 8: the facet before has no endfacet"},
        {replaced(text, "vertex 1 1 1", "vertex 1 nan 1"), "is not finite"}};
    for (const auto& [bytes, message] : cases) EXPECT_NE(error(bytes).find(message), std::string::npos) << error(bytes);
}

std::string off(const std::string& keyword, const std::string& after_vertex, const std::string& after_face,
                const std::string& between = "\n") {
    std::string text = keyword + "\n8 6 12\n";
    for (int v = 0; v < 8; ++v) text += coordinates(v) + after_vertex + between;
    for (const auto& quad : kQuads) {
        text += "4";
        for (const int v : quad) text += " " + std::to_string(v);
        text += after_face + between;
    }
    return text;
}

TEST(MeshFormats, OffAsProgramsWriteIt) {
    const TemporaryFolder folder;
    const std::string text = off("OFF", "", "");
    expect_cube(folder, "plain.off", text);
    expect_cube(folder, "windows.off", replaced(text, "\n", "\r\n"));
    expect_cube(folder, "old-mac.off", replaced(text, "\n", "\r"));
    expect_cube(folder, "comments.off", "# first\n" + replaced(text, "\n", " # 1 2 3\n\n# and\n"));
    expect_cube(folder, "counts-beside.off", replaced(text, "OFF\n", "OFF "));
    expect_cube(folder, "no-edges.off", replaced(text, "8 6 12", "8 6"));
    expect_cube(folder, "across-lines.off", off("OFF", "", "", " "));
    expect_cube(folder, "a-word-a-line.off", replaced(text, " ", "\n"));
    expect_cube(folder, "no-edges-across.off", replaced(text, " ", "\t"));
    expect_cube(folder, "face-colors.off", off("OFF", "", " 255 0 0"));
    expect_cube(folder, "more-numbers.off", off("OFF", " 0.5 0.5 0.5", ""));
    expect_cube(folder, "mark.off", "\xef\xbb\xbf" + text);
    for (const char* color : {" 255 0 0 255", " 255 0 0", " 0.1 0.2 0.3 1"})
        expect_cube(folder, "colors.off", off("COFF", color, ""), "colours of vertices are not used");
    expect_cube(folder, "colors-across.off", off("COFF", " 255 0 0 255", "", " "), "colours of vertices are not used");
    const Scene both = load_scene(folder.file("both.off", off("NCOFF", " 255 0 0 255 0 0 1", "")));
    EXPECT_EQ(warnings_with(both, "normals beside colours are not read"), 1u);
    EXPECT_EQ(both.meshes.at(0).positions.size(), 24u);
    expect_cube(folder, "weights.off", replaced(off("4OFF", " 1", ""), "1 1 1 1", "2 2 2 2"));
    expect_cube(folder, "texture.off", off("STOFF", " 0.5 0.5", ""));
    expect_cube(folder, "zero-normals.off", off("NOFF", " 0 0 0", ""));
    const Scene normals = load_scene(folder.file("normals.off", off("NOFF", " 0 0 1", "")));
    EXPECT_EQ(normals.meshes.at(0).normals.at(0), glm::vec3(0.0f, 0.0f, 1.0f));
    const auto error = [&](const std::string& bytes) { return load_error(folder.file("a.off", bytes)); };
    const std::pair<std::string, const char*> cases[] = {
        {replaced(text, "4 1 3 7 5", "4 1 3 7 8"), "OFF: face 5 refers to vertex 8, there are 8"},
        {replaced(text, "4 1 3 7 5", "4 1 3 7"), "OFF: face 5: the file ends early"},
        {replaced(text, "1 1 1\n", "1 y 1\n"), "OFF: vertex 7: \"y\" is no number"},
        {replaced(text, "8 6 12", "9 6 12"), "OFF: "},
        {replaced(text, "8 6 12", "8 x 12"), "\"x\" where the numbers of vertices and faces are expected"},
        {"OFF BINARY\n", "binary OFF files are not supported; write it as text"},
        {"nOFF 4\n", "OFF files of N dimensions are not supported"},
        {"OFF\n2 0 0\n0 0 0\n1 1 1\n", "contains no triangles, only 2 points"}};
    for (const auto& [bytes, message] : cases) EXPECT_NE(error(bytes).find(message), std::string::npos) << error(bytes);
}

}  // namespace
}  // namespace pellucid
