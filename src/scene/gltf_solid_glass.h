#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <map>
#include <set>
#include <vector>

namespace pellucid {

/// Closed meshes whose glass has no volume. glTF calls them thin-walled, but programs that cannot write the extension
/// mean solid glass by them.
class SolidGlass {
public:
    /// `make`: LoadOptions::solid.
    SolidGlass(bool make, Scene& scene, Warnings& warnings) : make_(make), scene_(scene), warnings_(warnings) {}

    struct Part {
        const Mesh* mesh;
        int* material;  ///< index into Scene::materials; becomes that of its solid twin
    };
    /// For the primitives of one mesh, which may be closed together only.
    void apply(const std::vector<Part>& primitives);
    /// Says once for all materials that there is the option, where it is not chosen.
    void warn();

private:
    void apply_closed(const Part& part);

    bool make_;
    Scene& scene_;
    Warnings& warnings_;
    std::map<int, int> twin_;  ///< of solid glass, by material
    std::set<int> thin_;       ///< materials of closed meshes that stay thin
};

}  // namespace pellucid
