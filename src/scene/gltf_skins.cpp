// Skins and morph targets of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, sections 3.7.2.2 and 3.7.3).
#include "scene/gltf_skins.h"

#include "core/fail.h"
#include "core/math.h"
#include "scene/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Tolerance on the sum of weights: 8-bit weights are off by up to half a step each.
constexpr float kWeightTolerance = 0.01f;

/// A pair of the attributes JOINTS_n and WEIGHTS_n.
struct InfluenceSet {
    std::vector<glm::uvec4> joints;
    std::vector<glm::vec4> weights;
};

std::vector<InfluenceSet> read_sets(const GltfFile& gltf, const tinygltf::Primitive& primitive, std::size_t vertices,
                                    const std::string& user) {
    std::vector<InfluenceSet> sets;
    const auto& attributes = primitive.attributes;
    for (int n = 0;; ++n) {
        const auto joints = attributes.find(fmt::format("JOINTS_{}", n));
        const auto weights = attributes.find(fmt::format("WEIGHTS_{}", n));
        if (joints == attributes.end() && weights == attributes.end()) return sets;
        if (joints == attributes.end() || weights == attributes.end())
            fail(gltf.path, fmt::format("{}: JOINTS_{} and WEIGHTS_{} need each other", user, n, n));
        InfluenceSet set;
        set.joints = read_joints(gltf, joints->second, fmt::format("{} JOINTS_{}", user, n));
        const std::vector<float> numbers =
            read_fractions(gltf, weights->second, 4, fmt::format("{} WEIGHTS_{}", user, n));
        for (std::size_t i = 0; i < numbers.size(); i += 4) set.weights.push_back(glm::make_vec4(&numbers[i]));
        if (set.joints.size() < vertices || set.weights.size() < vertices)
            fail(gltf.path, fmt::format("{}: JOINTS_{} and WEIGHTS_{} have {} and {} values for {} vertices", user, n,
                                        n, set.joints.size(), set.weights.size(), vertices));
        sets.push_back(std::move(set));
    }
}

/// True if a joint matrix is affine, up to an exporter's rounding.
bool affine(const glm::dmat4& m) {
    constexpr double kRounding = 1e-3;
    return std::abs(m[0][3]) < kRounding && std::abs(m[1][3]) < kRounding && std::abs(m[2][3]) < kRounding &&
           std::abs(m[3][3] - 1.0) < kRounding;
}

bool finite(const std::vector<glm::vec3>& vectors) {
    return std::all_of(vectors.begin(), vectors.end(), [](const glm::vec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    });
}

void warn_about_weights(std::size_t unweighted, std::size_t unequal, const std::string& user, Warnings& warnings) {
    if (unequal > 0)
        warnings.add(fmt::format("{}: joint weights of {} vert{} do not add to 1, scaled", user, unequal,
                                 unequal == 1 ? "ex" : "ices"));
    if (unweighted > 0)
        warnings.add(fmt::format("{}: {} vert{} no joint weights, bound to the first joint that is named", user,
                                 unweighted, unweighted == 1 ? "ex has" : "ices have"));
}

}  // namespace

Skin read_gltf_skin(const GltfFile& gltf, int index, const NodeTree& tree) {
    if (index < 0 || std::size_t(index) >= gltf.model.skins.size())
        fail(gltf.path, fmt::format("there is no skin {}", index));
    const tinygltf::Skin& from = gltf.model.skins[std::size_t(index)];
    const std::string user = fmt::format("skin {}", from.name.empty() ? std::to_string(index) : from.name);
    if (from.joints.empty()) fail(gltf.path, user + ": has no joints");
    std::vector<char> placed(tree.rest.size(), 0);
    for (const int node : tree.order) placed[std::size_t(node)] = 1;
    for (const int joint : from.joints)
        if (joint < 0 || std::size_t(joint) >= placed.size() || !placed[std::size_t(joint)])
            fail(gltf.path, fmt::format("{}: joint {} is no node of a tree", user, joint));

    Skin skin{.joints = from.joints, .joint_from_bind = {}};
    skin.joint_from_bind.assign(from.joints.size(), glm::dmat4(1.0));
    if (from.inverseBindMatrices < 0) return skin;  // identity matrices
    const std::vector<float> numbers = read_floats(gltf, from.inverseBindMatrices, 16, user + " inverseBindMatrices");
    if (numbers.size() / 16 < from.joints.size())
        fail(gltf.path,
             fmt::format("{}: {} inverseBindMatrices for {} joints", user, numbers.size() / 16, from.joints.size()));
    for (std::size_t j = 0; j < from.joints.size(); ++j) {
        skin.joint_from_bind[j] = glm::make_mat4(&numbers[16 * j]);
        if (!affine(skin.joint_from_bind[j]))
            fail(gltf.path, fmt::format("{}: inverse bind matrix {} is not affine", user, j));
    }
    return skin;
}

Influences read_gltf_influences(const GltfFile& gltf, const tinygltf::Primitive& primitive, std::size_t vertices,
                                const std::string& user, Warnings& warnings) {
    const std::vector<InfluenceSet> sets = read_sets(gltf, primitive, vertices, user);
    Influences influences;
    if (sets.empty()) return influences;
    std::size_t unweighted = 0, unequal = 0;
    influences.first.push_back(0);
    for (std::size_t v = 0; v < vertices; ++v) {
        float sum = 0.0f;
        bool negative = false;
        const std::size_t begin = influences.joint.size();
        for (const InfluenceSet& set : sets) {
            for (int k = 0; k < 4; ++k) {
                negative = negative || set.weights[v][k] < 0.0f;
                if (!(set.weights[v][k] > 0.0f)) continue;
                influences.joint.push_back(set.joints[v][k]);
                influences.weight.push_back(set.weights[v][k]);
                sum += set.weights[v][k];
            }
        }
        if (!(sum > 0.0f) || !std::isfinite(sum)) {
            ++unweighted;
            influences.joint.resize(begin);
            influences.weight.resize(begin);
            influences.joint.push_back(sets.front().joints[v][0]);
            influences.weight.push_back(1.0f);
        } else {
            unequal += negative || std::abs(sum - 1.0f) > kWeightTolerance;
            for (std::size_t i = begin; i < influences.weight.size(); ++i) influences.weight[i] /= sum;
        }
        influences.first.push_back(static_cast<std::uint32_t>(influences.joint.size()));
    }
    warn_about_weights(unweighted, unequal, user, warnings);
    return influences;
}

void check_influences(const GltfFile& gltf, const Influences& influences, std::size_t joints, const std::string& user) {
    for (const std::uint32_t joint : influences.joint)
        if (joint >= joints)
            fail(gltf.path, fmt::format("{}: a vertex follows joint {}, the skin has {}", user, joint, joints));
}

std::vector<MorphTarget> read_gltf_targets(const GltfFile& gltf, const tinygltf::Primitive& primitive,
                                           std::size_t vertices, const std::string& user, Warnings& warnings) {
    std::vector<MorphTarget> targets(primitive.targets.size());
    for (std::size_t t = 0; t < targets.size(); ++t) {
        for (const auto& [attribute, accessor] : primitive.targets[t]) {
            const std::string what = fmt::format("{} target {} {}", user, t, attribute);
            if (attribute == "TANGENT") continue;  // tangents are not read
            if (attribute != "POSITION" && attribute != "NORMAL") {
                warnings.add(fmt::format("{}: left out: only positions and normals are morphed", what));
                continue;
            }
            std::vector<glm::vec3> displacements = read_vectors<3>(gltf, accessor, what);
            if (displacements.size() < vertices) {
                warnings.add(
                    fmt::format("{}: left out: {} values for {} vertices", what, displacements.size(), vertices));
            } else if (!finite(displacements)) {
                warnings.add(fmt::format("{}: left out: not finite", what));
            } else {
                displacements.resize(vertices);
                (attribute == "POSITION" ? targets[t].positions : targets[t].normals) = std::move(displacements);
            }
        }
    }
    return targets;
}

void gather_influences(Influences& influences, const std::vector<std::uint32_t>& source) {
    if (influences.first.empty()) return;
    Influences gathered;
    gathered.first.push_back(0);
    for (const std::uint32_t v : source) {
        for (std::uint32_t i = influences.first[v]; i < influences.first[v + 1]; ++i) {
            gathered.joint.push_back(influences.joint[i]);
            gathered.weight.push_back(influences.weight[i]);
        }
        gathered.first.push_back(static_cast<std::uint32_t>(gathered.joint.size()));
    }
    influences = std::move(gathered);
}

void gather_targets(std::vector<MorphTarget>& targets, const std::vector<std::uint32_t>& source) {
    const auto gather = [&](std::vector<glm::vec3>& vectors) {
        if (vectors.empty()) return;
        std::vector<glm::vec3> gathered;
        gathered.reserve(source.size());
        for (const std::uint32_t v : source) gathered.push_back(vectors[v]);
        vectors = std::move(gathered);
    };
    for (MorphTarget& target : targets) {
        gather(target.positions);
        gather(target.normals);
    }
}

}  // namespace pellucid
