// Animations of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 3.11).
#include "scene/gltf_animations.h"

#include "core/fail.h"
#include "scene/animation_names.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace pellucid {
namespace {

std::optional<AnimatedPart> part_of(const std::string& path) {
    if (path == "translation") return AnimatedPart::kTranslation;
    if (path == "rotation") return AnimatedPart::kRotation;
    if (path == "scale") return AnimatedPart::kScale;
    if (path == "weights") return AnimatedPart::kWeights;
    return std::nullopt;
}

class AnimationReader {
public:
    AnimationReader(const GltfFile& gltf, const NodeTree& tree, Warnings& warnings)
        : gltf_(gltf), tree_(tree), warnings_(warnings) {}

    Animation read(const tinygltf::Animation& from, std::size_t index) {
        Animation animation;
        animation.name = from.name.empty() ? fmt::format("animation {}", index) : from.name;
        for (std::size_t c = 0; c < from.channels.size(); ++c) {
            user_ = fmt::format("animation {} channel {}", from.name.empty() ? std::to_string(index) : from.name, c);
            if (auto channel = read_channel(from, from.channels[c])) animation.channels.push_back(std::move(*channel));
        }
        return animation;
    }

private:
    std::optional<Channel> read_channel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& from) {
        const auto left_out = [&](const std::string& why) {
            warnings_.add(fmt::format("{}: left out: {}", user_, why));
            return std::nullopt;
        };
        const std::optional<AnimatedPart> part = part_of(from.target_path);
        if (!part) return left_out(fmt::format("'{}' is not animated", from.target_path));
        if (from.target_node < 0) return left_out("it names no node");
        if (std::size_t(from.target_node) >= gltf_.model.nodes.size())
            fail(gltf_.path, fmt::format("{}: there is no node {}", user_, from.target_node));
        if (from.sampler < 0 || std::size_t(from.sampler) >= animation.samplers.size())
            fail(gltf_.path, fmt::format("{}: there is no sampler {}", user_, from.sampler));
        const std::size_t width = width_of(*part, from.target_node);
        const std::string node = gltf_node_name(gltf_, from.target_node);
        if (width == 0) return left_out(fmt::format("{} has no morph targets", node));
        if (*part != AnimatedPart::kWeights && tree_.rest[std::size_t(from.target_node)].matrix)
            return left_out(fmt::format("{} stands where its matrix says", node));
        Channel channel{.node = from.target_node, .part = *part, .keyframes = {}};
        channel.keyframes = read_keyframes(animation.samplers[std::size_t(from.sampler)], *part, width);
        return channel;
    }

    std::size_t width_of(AnimatedPart part, int node) const {
        if (part == AnimatedPart::kRotation) return 4;
        if (part != AnimatedPart::kWeights) return 3;
        const int mesh = gltf_.model.nodes[std::size_t(node)].mesh;
        if (mesh < 0 || std::size_t(mesh) >= gltf_.model.meshes.size()) return 0;
        return morph_target_count(gltf_.model.meshes[std::size_t(mesh)]);
    }

    Keyframes read_keyframes(const tinygltf::AnimationSampler& from, AnimatedPart part, std::size_t width) {
        Keyframes k;
        k.width = width;
        if (from.interpolation == "STEP") {
            k.interpolation = Interpolation::kStep;
        } else if (from.interpolation == "CUBICSPLINE") {
            k.interpolation = Interpolation::kCubicSpline;
        } else if (from.interpolation != "LINEAR") {
            fail(gltf_.path, fmt::format("{}: unknown interpolation '{}'", user_, from.interpolation));
        }
        k.times = read_floats(gltf_, from.input, 1, user_ + " times");
        if (k.times.empty()) fail(gltf_.path, user_ + ": has no keyframes");
        check_times(k.times);

        // Only rotations and weights may be stored as integers. Weights are stored as scalars.
        const bool weights = part == AnimatedPart::kWeights;
        const auto read = weights || part == AnimatedPart::kRotation ? read_fractions : read_floats;
        k.values = read(gltf_, from.output, weights ? 1 : int(width), user_ + " values");
        const std::size_t rows = k.interpolation == Interpolation::kCubicSpline ? 3 : 1;
        if (k.values.size() != k.times.size() * rows * width)
            fail(gltf_.path, fmt::format("{}: {} times need {} numbers, there are {}", user_, k.times.size(),
                                         k.times.size() * rows * width, k.values.size()));
        if (part == AnimatedPart::kRotation) check_rotations(k, rows);
        return k;
    }

    void check_times(const std::vector<float>& times) {
        std::size_t repeated = 0;
        for (std::size_t i = 1; i < times.size(); ++i) {
            if (times[i] < times[i - 1])
                fail(gltf_.path, fmt::format("{}: time {} ({} s) is before the one at {}", user_, i, times[i], i - 1));
            repeated += times[i] == times[i - 1];
        }
        if (repeated > 0)
            warnings_.add(fmt::format("{}: {} time{} repeated, the last value there counts", user_, repeated,
                                      repeated == 1 ? " is" : "s are"));
    }

    void check_rotations(const Keyframes& k, std::size_t rows) const {
        for (std::size_t key = 0; key < k.times.size(); ++key) {
            const float* const q = &k.values[(key * rows + rows / 2) * 4];
            if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 1e-12f))
                fail(gltf_.path, fmt::format("{}: rotation {} is zero", user_, key));
        }
    }

    const GltfFile& gltf_;
    const NodeTree& tree_;
    Warnings& warnings_;
    std::string user_;  ///< the current channel, for messages
};

}  // namespace

std::vector<Animation> read_gltf_animations(const GltfFile& gltf, const NodeTree& tree, Warnings& warnings) {
    AnimationReader reader(gltf, tree, warnings);
    std::vector<Animation> animations;
    for (std::size_t i = 0; i < gltf.model.animations.size(); ++i)
        animations.push_back(reader.read(gltf.model.animations[i], i));
    return animations;
}

std::size_t morph_target_count(const tinygltf::Mesh& mesh) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) count = std::max(count, primitive.targets.size());
    return count;
}

const Animation* chosen_animation(const GltfFile& gltf, const std::vector<Animation>& animations,
                                  const LoadOptions& options) {
    if (!options.animation && !options.time_s) return nullptr;
    if (!options.animation && !animations.empty()) return &animations.front();
    return &animations[find_animation(animations, options.animation.value_or(""), gltf.path.string())];
}

}  // namespace pellucid
