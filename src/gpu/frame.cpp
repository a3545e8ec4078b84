#include "gpu/frame.h"

namespace pellucid {

std::vector<Binding> frame_bindings(const Frame& frame) {
    const GpuScene& scene = frame.scene;
    return {reads("Frame", frame.constants),
            reads("Objects", scene.objects),
            reads("Materials", scene.materials),
            reads("Indices", scene.indices),
            reads("Vertices", scene.vertices),
            reads("Appearance", scene.appearance),
            reads("Textures", scene.textures),
            reads("texture_pages", scene.texture_pages),
            reads_layer("environment_map", frame.environment, 0),
            reads_layer("filtered_environment", frame.filtered_environment, 0)};
}

}  // namespace pellucid
