#include <pellucid/thickness.h>

#include <pellucid/names.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <vector>

namespace pellucid {
namespace {

constexpr std::array<ThicknessMethodInfo, 8> kMethods = {{
    {ThicknessMethod::kTranslucentShadowMap, "translucent-shadow-map",
     "from the first surface that the light meets; gaps count as solid",
     "Dachsbacher & Stamminger, Translucent Shadow Maps, EGSR 2003"},
    {ThicknessMethod::kLocalThickness, "local-thickness",
     "occlusion with inverted normals, baked per vertex; whatever the light's direction",
     "Barré-Brisebois & Bouchard, Approximating Translucency, GDC 2011"},
    {ThicknessMethod::kDepthPeeling, "depth-peeling", "layers from the light, one geometry pass each",
     "Chen, Real-time transmission of translucent objects by depth peeling"},
    {ThicknessMethod::kDualDepthPeeling, "dual-depth-peeling", "layers from the light, two per geometry pass",
     "Chen, Real-time transmission of translucent objects by depth peeling"},
    {ThicknessMethod::kLayers, "layers", "layers from the light, all in one geometry pass",
     "Pellucid, docs/translucency.md"},
    {ThicknessMethod::kPublishedShadowMap, "published-shadow-map",
     "difference to the depth of the nearest texel, without a bias",
     "Chen, Real-time transmission of translucent objects by depth peeling, introduction"},
    {ThicknessMethod::kPublishedLocalThickness, "published-local-thickness",
     "share of the samples around a vertex that lie inside, baked; in half diagonals of the mesh's box",
     "Chen, Real-time transmission of translucent objects by depth peeling, introduction"},
    {ThicknessMethod::kPublishedDepthPeeling, "published-depth-peeling",
     "stored depths of the nearest texel up to the point's own",
     "Chen, Real-time transmission of translucent objects by depth peeling, section 1.3"},
}};

}  // namespace

std::span<const ThicknessMethodInfo> thickness_methods() { return kMethods; }

ThicknessMethod parse_thickness_method(std::string_view name) {
    std::vector<std::string_view> known;
    for (const ThicknessMethodInfo& info : kMethods) {
        if (info.name == name) return info.method;
        known.push_back(info.name);
    }
    throw unknown_name("thickness method", name, known);
}

}  // namespace pellucid
